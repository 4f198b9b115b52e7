#include "tests/evaluation/camera_turn.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace framelet::bench {

double turned_degrees(CameraTurn const& turn, SceneTime time) {
    if (!turn.turns() || time <= 0) {
        return 0;
    }
    double const round = 4 * turn.reach_degrees;
    double const along = std::fmod(turn.degrees_per_second * time + turn.reach_degrees, round);
    return along < 0.5 * round ? along - turn.reach_degrees : 3 * turn.reach_degrees - along;
}

Camera turned(Camera const& camera, CameraTurn const& turn, SceneTime time) {
    Camera result = camera;
    if (turn.turns()) {
        auto const radians = static_cast<float>(glm::radians(turned_degrees(turn, time)));
        result.orientation = glm::normalize(camera.orientation * glm::angleAxis(radians, Vec3(0, 1, 0)));
    }
    return result;
}

} // namespace framelet::bench
