// Quantises layers and outliers to numbers of 8 and 16 bits, each in a unit that is a power of two, and back.
// PROTOCOL.md says how the bytes are arranged. In: finite numbers. Out: codes, and the very numbers that a reader makes
// of them.
#pragma once

#include <cstdint>

#include "common/framelet/framelet_shape.h"

namespace framelet {

/// Code of a unit. 0: the unit is 0, and so is what is stated in it; else the unit is 2^(code - 128).
using UnitCode = std::uint8_t;
inline constexpr UnitCode largest_unit = 168;
double unit_of(UnitCode code);
/// The smallest unit above a value > 0 within 2^-127 .. 2^40; 0 for 0.
UnitCode unit_above(double value);

struct LayerCode {
    UnitCode unit = 0;
    std::uint8_t error = 0; ///< units
    std::int16_t at = 0; ///< units
    std::int16_t dx = 0, dy = 0; ///< units along the tile's side
};

/// Quantises a layer of a tile whose side is 2^side_bits pixels. The decoded plane is within 3/2 units of the layer
/// anywhere on the tile, and its error is the layer's and the distance between the two planes, rounded up: whatever is
/// within the layer's error of the layer is within the decoded error of the decoded plane. The unit is at most the
/// larger of an eighth of the layer's error and 2^-9 of |at| + side (|dx| + |dy|), about its largest inverse depth:
/// what moves by 32 pixels because the camera moves is shown a tenth of a pixel off at most, mostly a third of that.
LayerCode quantise(Layer const& layer, int side_bits);
/// The layer that a reader makes of the code, without body and drift.
Layer dequantise(LayerCode const& code, int side_bits);

/// Largest codes: values are rounded to whole units, and the unit is that above the largest of all values that share
/// it, divided by these. Outliers are few samples: moved by 20 pixels they are shown a twelfth of a pixel off at most.
inline constexpr double largest_inverse_depth_code = 255, largest_drift_code = 32767;
std::uint8_t quantise_inverse_depth(float inverse_depth, UnitCode unit);
std::int16_t quantise_drift(float component, UnitCode unit);

/// Code of a jerk: 0 for 0, else of 2^((code - 128) / 8) metres a second cubed. It is rounded up, as far as codes go.
using JerkCode = std::uint8_t;
JerkCode quantise_jerk(float jerk);
float jerk_of(JerkCode code);

} // namespace framelet
