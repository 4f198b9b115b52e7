#include "server/schedule/view_motion.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace framelet {

float view_displacement(ViewRays const& from, ViewRays const& to, Vec2 pixel, float inverse_depth, float most_pixels) {
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
        return most_pixels;
    }
    if (!(scale > 0)) {
        return perspective ? most_pixels : 0;
    }
    Vec3 const place = relative / scale - corner;
    Vec2 const there(glm::dot(place, dx) / glm::dot(dx, dx), glm::dot(place, dy) / glm::dot(dy, dy));
    float const distance = glm::distance(pixel, there);
    return distance < most_pixels ? distance : most_pixels; // NaN is far
}

} // namespace framelet
