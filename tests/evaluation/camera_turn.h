// A camera that turns back and forth, on top of its other motion, as a hand or a head turns it: nobody but who holds it
// can foretell that.
#pragma once

#include "common/camera.h"
#include "common/framelet/framelet.h"

namespace framelet::bench {

/// A turning about the camera's own up axis, at constant speed: from straight ahead to `reach_degrees` on the left,
/// back through straight ahead to as far on the right, and so on.
struct CameraTurn {
    double degrees_per_second = 0; ///< 0: it does not turn
    double reach_degrees = 30; ///< > 0

    bool turns() const { return degrees_per_second > 0; }
};

/// Angle in degrees by which the camera has turned at `time`; 0 until time 0.
double turned_degrees(CameraTurn const& turn, SceneTime time);

Camera turned(Camera const& camera, CameraTurn const& turn, SceneTime time);

} // namespace framelet::bench
