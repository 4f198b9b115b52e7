// How fast bodies pass each other in the picture. A viewer that moves what it holds does not need to be sent what goes
// on as one; what comes out behind a body, or goes under it, it does not have. In: a rendered framelet, its camera, how
// bodies move. Out: pixels a second.
#pragma once

#include "common/framelet/body_motion.h"
#include "common/framelet/framelet.h"
#include "common/framelet/tile.h"

namespace framelet {

/// The moment at which framelets were rendered.
struct RenderedMoment {
    ViewRays rays{}; ///< perspective
    SceneTime scene_time = 0;
    BodyMotions const* motions = nullptr; ///< as the viewer knows them; null: it moves nothing
};

/// The fastest at which two bodies that meet among samples [first, first + count) pass each other, pixels for each
/// second of scene time; 0 where they do not. Looks at some of the places where they meet. Finite.
float meeting_speed(Framelet const& framelet, ImagePlane const& plane, RenderedMoment const& moment, std::size_t first,
                    std::size_t count);

} // namespace framelet
