// Samples of framelets with loss: quantised Haar details of luma and chroma, chroma beside a share of luma. In: luma
// and chroma of framelets, or what is left of them beside a prediction; their QP. Out: levels, and back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/codec/color/display_values.h"

namespace framelet {

inline constexpr std::size_t haar_octaves = 4;
/// Of an octave, from the finest (0).
constexpr std::size_t haar_blocks(std::size_t octave) {
    return std::size_t{framelet_samples} >> (2 * (octave + 1));
}
/// Details of the octaves of one plane, the coarsest first, each [0, h, v, d] a block.
inline constexpr std::array<std::size_t, haar_octaves> first_four{84, 20, 4, 0};

/// Of one plane, its octaves from the coarsest, each [mean, h, v, d] a block.
using Fours = std::array<std::int16_t, 4 * (64 + 16 + 4 + 1)>;

/// Details of a framelet's three planes and the planes' means, quantised; 0 instead of the means of blocks.
struct HaarLevels {
    std::array<Fours, 3> details;
    std::array<std::int16_t, 3> means;
    /// Eighths of luma's details that those of Co and of Cg have besides, -8..7.
    std::array<std::int8_t, 2> shares;
};

/// A way of coding a framelet, and the details that it was made of, sixteenths.
struct HaarCode {
    std::array<Fours, 3> values;
    HaarLevels levels;
    std::array<int, 3> bits; ///< that each plane's details will take, roughly, before luma is shared
};

/// Returns the bits that the levels will take, roughly: what ways of coding a framelet are compared by. Above `most` it
/// gives up, and the levels are not to be used. `qp` is 1..coarsest_qp.
int code(DisplayValues const& values, std::uint8_t qp, int most, HaarCode& out);
/// Quantises chroma again, beside a share of luma, where that takes less.
void share_luma(std::uint8_t qp, HaarCode& code);
/// What a reader makes of the levels.
DisplayValues dequantise(HaarLevels const& levels, std::uint8_t qp);

} // namespace framelet
