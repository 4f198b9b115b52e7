// Draws over a picture which of its pixels nothing is held of. In: confidence of every pixel, or what is held; the
// picture. Out: magenta in these pixels.
#pragma once

#include <span>

#include "common/held/framelet_cache.h"
#include "common/image.h"
#include "common/picture/confidence.h"

namespace framelet {

/// Draws over a picture of what was moved. `confidence` has one for each pixel, in rows.
void draw_holes(std::span<PixelConfidence const> confidence, Picture& picture);
/// Draws over a picture of which nothing was moved, and which has the viewport's size.
void draw_holes(FrameletCache const& cache, Picture& picture);

} // namespace framelet
