#include "common/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace framelet {

ViewRays make_view_rays(Camera const& camera, Viewport viewport) {
    float const height = static_cast<float>(viewport.height);
    float const width = static_cast<float>(viewport.width);
    float const extent = camera.projection == Projection::perspective ? 2 * std::tan(0.5f * camera.vertical_extent)
                                                                      : camera.vertical_extent;
    float const pixel = extent / height; // a pixel's side at depth 1, or in metres if orthographic
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

namespace {

struct Range {
    float least, most;
    bool contains(float value) const { return value >= least && value <= most; } // false for NaN
};

constexpr Range coordinates{-max_camera_coordinate, max_camera_coordinate};

Range extents(Projection projection) {
    return projection == Projection::perspective ? Range{least_field_of_view, most_field_of_view}
                                                 : Range{least_view_height, most_view_height};
}

} // namespace

bool is_valid(Camera const& camera) {
    Vec3 const p = camera.position;
    float const norm = glm::dot(camera.orientation, camera.orientation);
    return coordinates.contains(p.x) && coordinates.contains(p.y) && coordinates.contains(p.z) &&
           std::abs(norm - 1) < 1e-3f && extents(camera.projection).contains(camera.vertical_extent);
}

Camera within_bounds(Camera camera) {
    Range const extent = extents(camera.projection);
    camera.position = glm::clamp(camera.position, coordinates.least, coordinates.most);
    camera.vertical_extent = std::clamp(camera.vertical_extent, extent.least, extent.most);
    return camera;
}

} // namespace framelet
