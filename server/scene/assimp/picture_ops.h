// Finds what pictures of older material formats hold, and turns them into what a Material wants.
// In and out: pictures.
#pragma once

#include "common/image.h"

namespace framelet {

/// `color` (white where null) with the alpha of `opacity`: its alpha channel where that varies, else its brightness.
/// The result has `color`'s size; `opacity` is sampled at the nearest pixel.
Picture with_opacity(Picture const* color, Picture const& opacity);

/// True where nearly every pixel is wholly opaque or wholly transparent.
bool is_cutout(Picture const& picture);

/// True where the colours are those of a tangent-space normal map: bluish on the whole, not grey.
bool is_normal_map(Picture const& picture);

} // namespace framelet
