// Filters outlines of a moved picture to about the mean over a pixel's area: what was moved to another camera has a
// sample at each pixel's centre, and its outlines are stairs. In: a picture, and which of its pixels were moved. Out:
// the picture with these filtered.
#pragma once

#include "common/framelet/tile.h"
#include "common/image.h"

namespace framelet {

/// Largest difference of green bytes that is not an outline: what a surface shows stays sharp.
inline constexpr int flat_contrast = 26;

/// Alpha of a pixel that `filter_pixels` is to leave as it is (filled holes too); it filters those with another one.
inline constexpr std::uint8_t exact_alpha = 255;

/// Writes `rect` of `filtered` from `picture`, which has its size. Pixels with `exact_alpha` stay as they are, and
/// those that differ from none of the four beside them by more than `contrast`. The others become, in linear light
/// (squares of bytes stand for it), half of themselves and an eighth of each of the four; beyond the border the pixel
/// is repeated. `rect` lies in the picture. Alpha becomes 255. With a contrast of 255 nothing is filtered.
void filter_pixels(Picture const& picture, PixelRect const& rect, Picture& filtered, int contrast = flat_contrast);

} // namespace framelet
