#include "tests/evaluation/correspondence/exact_motion.h"

#include <cmath>

#include <glm/matrix.hpp>

namespace framelet::bench {

namespace {

/// The least ratio of a point's view depth in the second view to that in the first: below it the point is as good as
/// behind the eye.
constexpr float nearest = 0.05f;

} // namespace

ExactMotion::ExactMotion(SceneBodies const& bodies, SceneView const& from, SceneView const& to, Viewport viewport)
    : seconds_(static_cast<float>(to.pose.time - from.pose.time)), rays_(make_view_rays(from.camera, viewport)) {
    ViewRays const rays = make_view_rays(to.camera, viewport);
    eye_ = rays.origin;
    to_pixels_ = glm::inverse(Mat3(rays.direction_dx, rays.direction_dy, rays.direction));
    for (std::size_t body = 0; body < bodies.frames.size(); ++body) {
        auto const number = static_cast<BodyNumber>(body);
        poses_.emplace_back(body_pose(bodies, from.pose, number), body_pose(bodies, to.pose, number));
    }
}

ExactMotion::Projected ExactMotion::shown(Vec2 position, float inverse_depth, BodyNumber body,
                                          Drift const& drift) const {
    Vec3 const direction = rays_.direction + rays_.direction_dx * position.x + rays_.direction_dy * position.y;
    // Vector from the second eye to the point, times the inverse depth; for the sky the direction alone.
    Vec3 towards = direction;
    if (inverse_depth > 0) {
        Vec3 point = rays_.origin + direction / inverse_depth;
        if (body != static_body) {
            auto const& [before, after] = poses_[body];
            Vec3 const in_body = (glm::conjugate(before.rotation) * (point - before.translation)) / before.scale;
            point = after.rotation * (after.scale * in_body) + after.translation;
        }
        towards = (point + drift.after(seconds_) - eye_) * inverse_depth;
    }
    Vec3 const p = to_pixels_ * towards;
    return p.z > nearest ? Projected{Vec2(p) / p.z, inverse_depth / p.z} : Projected{};
}

} // namespace framelet::bench
