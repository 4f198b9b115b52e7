#include "server/sampling/field/view_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {

std::optional<Vec2> moved_pixel(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth) {
    // The point by homogeneous coordinates, so that a depth of infinity is a direction.
    Vec3 const origin = from.origin + from.origin_dx * pixel.x + from.origin_dy * pixel.y;
    Vec3 const direction = from.direction + from.direction_dx * pixel.x + from.direction_dy * pixel.y;
    Vec3 const relative = (origin - to.origin) * inverse_depth + direction;
    bool const perspective = glm::dot(to.direction_dx, to.direction_dx) > 0;
    Vec3 const dx = perspective ? to.direction_dx : to.origin_dx;
    Vec3 const dy = perspective ? to.direction_dy : to.origin_dy;
    float scale = inverse_depth; // of `relative` to the plane of coordinates
    Vec3 corner(0);
    if (perspective) {
        Vec3 const normal = glm::cross(dx, dy);
        scale = glm::dot(relative, normal) / glm::dot(to.direction, normal);
        corner = to.direction;
    }
    if (!perspective && glm::dot(relative, to.direction) < 0) {
        return std::nullopt;
    }
    if (!(scale > 0)) {
        return perspective ? std::nullopt : std::optional(pixel);
    }
    Vec3 const from_corner = relative / scale - corner;
    Vec2 const there(glm::dot(from_corner, dx) / glm::dot(dx, dx), glm::dot(from_corner, dy) / glm::dot(dy, dy));
    return std::isfinite(there.x) && std::isfinite(there.y) ? std::optional(there) : std::nullopt;
}

float view_displacement(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth, float most_pixels) {
    std::optional<Vec2> const there = moved_pixel(from, to, pixel, inverse_depth);
    return there ? std::min(glm::distance(pixel, *there), most_pixels) : most_pixels;
}

} // namespace framelet
