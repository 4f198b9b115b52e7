#include "server/render/prepared/light_frame.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace framelet {
namespace {

/// World units of the length that a unit of the instance's own space has, about.
float scale_of(Instance const& instance) {
    return std::cbrt(std::abs(glm::determinant(instance.linear)));
}

} // namespace

LightPlace light_place(PreparedScene const& scene, std::uint32_t number, Vec3 const& position, Vec3 const& normal) {
    Instance const& instance = scene.instances[number];
    if (!instance.moves()) {
        return {0, position, normal};
    }
    Vec3 const own = glm::transpose(instance.normal_matrix) * (position - instance.translation);
    return {number + 1, own * scale_of(instance), glm::normalize(glm::transpose(instance.linear) * normal)};
}

LightFrame light_frame(PreparedScene const& scene, std::uint32_t frame) {
    if (frame == 0) {
        return {};
    }
    Instance const& instance = scene.instances[frame - 1];
    float const scale = std::max(scale_of(instance), 1e-20f);
    return {instance.normal_matrix * scale, instance.linear / scale, instance.translation};
}

} // namespace framelet
