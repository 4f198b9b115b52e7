// Draws outlines of the framelets that the viewer holds over its picture. In: what it holds, the picture. Out: outlines
// in it, bright yellow where the framelet is fresh, over red to dark blue where it is old.
#pragma once

#include "common/held/framelet_pool.h"
#include "common/image.h"

namespace framelet {

/// `picture` has the viewport's size. Age counts in batches since the newest framelet that is held, on a logarithmic
/// scale: a picture that nothing new comes for does not age.
void draw_outlines(FrameletCache const& cache, Picture& picture);

/// Draws the outlines of what the newest batch has brought alone, all of them bright yellow, where that was rendered.
/// `picture` has the viewport's size.
void draw_arrivals(FrameletPool const& pool, Picture& picture);

} // namespace framelet
