// Codes samples of framelets with loss: as quantised Haar details of luma and chroma, chroma beside a share of luma.
// In: luma and chroma of framelets, or their residual beside a prediction; their QP. Out: levels, and back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/codec/color/display_values.h"

namespace framelet {

inline constexpr std::size_t haar_octaves = 4;
/// Number of blocks in an octave of one plane; 0 is the finest.
constexpr std::size_t haar_blocks(std::size_t octave) {
    return std::size_t{framelet_samples} >> (2 * (octave + 1));
}
/// Index in `PlaneDetails` at which each octave, counted from the finest, begins.
inline constexpr std::array<std::size_t, haar_octaves> octave_first{84, 20, 4, 0};

/// Details of one plane: its octaves from the coarsest, each block of them as [mean, h, v, d].
using PlaneDetails = std::array<std::int16_t, 4 * (64 + 16 + 4 + 1)>;

/// Details of a framelet's three planes and the planes' means, quantised; 0 instead of the means of blocks.
struct HaarLevels {
    std::array<PlaneDetails, 3> details;
    std::array<std::int16_t, 3> means;
    /// Share of luma that the details of Co and of Cg have besides their own levels, in eighths of the details of luma,
    /// -8..7.
    std::array<std::int8_t, 2> shares;
};

/// A way of coding a framelet, and the details that it was made of, sixteenths.
struct HaarCode {
    std::array<PlaneDetails, 3> values;
    HaarLevels levels;
    std::array<int, 3> bits; ///< what each plane's details will take, roughly, before luma is shared
};

/// Transforms and quantises a framelet. Returns the bits that the levels will take, roughly, by which ways of coding a
/// framelet are compared. Once these are more than `most` it gives up, and the levels are not to be used. `qp` is
/// 1..coarsest_qp.
int code(DisplayValues const& values, std::uint8_t qp, int most, HaarCode& out);
/// Quantises chroma again, less a share of luma, where that takes fewer bits.
void share_luma(std::uint8_t qp, HaarCode& code);
/// The values that a reader makes of the levels.
DisplayValues dequantise(HaarLevels const& levels, std::uint8_t qp);

} // namespace framelet
