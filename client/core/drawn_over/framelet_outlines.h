// Draws outlines of the framelets that the viewer holds over its picture. In: the cache, the picture. Out: outlines in
// it, bright yellow where the framelet is fresh, over red to dark blue where it is old.
#pragma once

#include "common/held/framelet_cache.h"
#include "common/image.h"

namespace framelet {

/// `picture` has the viewport's size. Age counts in batches since the newest framelet that is held, on a logarithmic
/// scale: a picture that nothing new comes for does not age.
void draw_outlines(FrameletCache const& cache, Picture& picture);

} // namespace framelet
