#include "tests/evaluation/correspondence/flight.h"

#include <glm/gtc/quaternion.hpp>

namespace framelet::bench {

Camera flown(Camera camera, float median_depth, double seconds) {
    constexpr float depths_a_second = 0.5f;
    constexpr float radians_a_second = 0.5235988f;
    auto const s = static_cast<float>(seconds);
    camera.position += depths_a_second * median_depth * s * camera.right();
    camera.orientation = glm::normalize(glm::angleAxis(radians_a_second * s, Vec3(0, 1, 0)) * camera.orientation);
    return camera;
}

} // namespace framelet::bench
