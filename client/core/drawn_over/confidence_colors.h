// Draws over a picture how far its pixels are to be trusted. In: confidence of every pixel, the picture. Out: the
// picture in grey, washed with the colours of age.
#pragma once

#include <span>

#include "common/image.h"
#include "common/picture/confidence.h"

namespace framelet {

/// `confidence` has one for each pixel, in rows. Fresh pixels are yellow, older ones orange, red and dark blue, on a
/// logarithmic scale from a hundredth of a second to ten; what is made up is magenta. The coarser the samples
/// the darker.
void draw_confidence(std::span<PixelConfidence const> confidence, Picture& picture);

} // namespace framelet
