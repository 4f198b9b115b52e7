// A camera that turns back and forth, on top of whatever else it does: as a hand or a head does, and nobody can
// foretell who does not hold it.
#pragma once

#include "common/camera.h"
#include "common/framelet/framelet.h"

namespace framelet::bench {

/// About the camera's own up axis, to the left at first: from straight ahead to `reach` and, by way of straight ahead,
/// to as far on the other side, and so on, always at the same speed.
struct CameraTurn {
    double degrees_per_second = 0; ///< 0: it does not turn
    double reach_degrees = 30; ///< > 0

    bool turns() const { return degrees_per_second > 0; }
};

/// How far it has turned, degrees; 0 until time 0.
double turned_degrees(CameraTurn const& turn, SceneTime time);

Camera turned(Camera const& camera, CameraTurn const& turn, SceneTime time);

} // namespace framelet::bench
