#include "common/camera.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {

ViewRays make_view_rays(Camera const& camera, Viewport viewport) {
    float const height = static_cast<float>(viewport.height);
    float const width = static_cast<float>(viewport.width);
    float const extent = camera.projection == Projection::perspective ? 2 * std::tan(0.5f * camera.vertical_extent)
                                                                      : camera.vertical_extent;
    float const pixel = extent / height; // at depth 1, or in metres
    Vec3 const dx = camera.right() * pixel;
    Vec3 const dy = camera.up() * -pixel;
    Vec3 const corner = -0.5f * width * dx - 0.5f * height * dy;

    ViewRays rays{};
    rays.origin = camera.position;
    rays.direction = camera.forward();
    if (camera.projection == Projection::perspective) {
        rays.direction += corner;
        rays.direction_dx = dx;
        rays.direction_dy = dy;
    } else {
        rays.origin += corner;
        rays.origin_dx = dx;
        rays.origin_dy = dy;
    }
    return rays;
}

Camera look_at(Vec3 position, Vec3 target, Vec3 up, float vertical_fov_radians) {
    Vec3 const back = glm::normalize(position - target);
    if (glm::length(glm::cross(up, back)) < 1e-4f * glm::length(up)) {
        up = std::abs(back.y) > 0.9f ? Vec3(0, 0, back.y > 0 ? -1 : 1) : Vec3(0, 1, 0);
    }
    Vec3 const right = glm::normalize(glm::cross(up, back));
    Camera camera;
    camera.position = position;
    camera.orientation = glm::normalize(glm::quat_cast(Mat3(right, glm::cross(back, right), back)));
    camera.vertical_extent = vertical_fov_radians;
    return camera;
}

bool is_valid(Camera const& camera) {
    Vec3 const p = camera.position;
    float const norm = glm::dot(camera.orientation, camera.orientation);
    bool const pose = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::abs(norm - 1) < 1e-3f;
    bool const lens = camera.projection == Projection::perspective
                          ? camera.vertical_extent > 1e-4f && camera.vertical_extent < 3.13f
                          : camera.vertical_extent > 0 && std::isfinite(camera.vertical_extent);
    return pose && lens;
}

} // namespace framelet
