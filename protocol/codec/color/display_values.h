// Display samples as luma and chroma, and back. In: red, green, blue bytes. Out: three planes of integers in
// sixteenths, Y about the middle grey (YCoCg, [Malvar 2003]).
#pragma once

#include <array>
#include <cstdint>

#include "common/framelet/framelet.h"

namespace framelet {

/// 16 Y - 2048, 16 Co, 16 Cg of each sample, in the framelet's order: Y = (R + 2 G + B) / 4, Co = (R - B) / 2,
/// Cg = (2 G - R - B) / 4. Arithmetic is modulo 2^16.
struct DisplayValues {
    std::array<std::array<std::int16_t, framelet_samples>, 3> planes;
};

DisplayValues display_values(DisplayFramelet const& framelet);
/// The difference `framelet` - `predicted`, of which Y has nothing subtracted.
DisplayValues difference(DisplayFramelet const& framelet, DisplayFramelet const& predicted);
/// Puts the values into the samples of `framelet`, rounded and clamped; its tile stays.
void to_samples(DisplayValues const& values, DisplayFramelet& framelet);
/// Puts the sum of `left` and `predicted` into the samples of `framelet`, likewise.
void add_to_samples(DisplayValues const& left, DisplayFramelet const& predicted, DisplayFramelet& framelet);

} // namespace framelet
