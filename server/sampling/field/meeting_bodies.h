// Measures how fast bodies pass each other in the picture. A viewer that moves its samples need not be sent what moves
// as one; but where two bodies meet, one uncovers (disocclusion) or covers the other. In: a rendered framelet, its
// camera, how bodies move. Out: pixels a second.
#pragma once

#include "common/framelet/body_motion.h"
#include "common/framelet/framelet.h"
#include "common/framelet/tile.h"

namespace framelet {

/// The moment at which framelets were rendered.
struct RenderedMoment {
    ViewRays rays{}; ///< perspective
    SceneTime scene_time = 0;
    BodyMotions const* motions = nullptr; ///< as the viewer knows them; null: it moves no samples
};

/// Greatest speed at which two bodies that meet among samples [first, first + count) pass each other, pixels a second
/// of scene time; 0 where none meet. Looks only at some of the points at which they meet. Finite.
float meeting_speed(Framelet const& framelet, ImagePlane const& plane, RenderedMoment const& moment, std::size_t first,
                    std::size_t count);

} // namespace framelet
