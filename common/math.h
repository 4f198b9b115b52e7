// Vector types used everywhere. World space is right-handed, +Y up, metres (glTF's convention).
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace framelet {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Quat = glm::quat;

/// Axis-aligned box in world space, metres. Empty until the first `include`.
struct Bounds {
    Vec3 lower{INFINITY};
    Vec3 upper{-INFINITY};

    bool empty() const { return !(lower.x <= upper.x); }
    Vec3 center() const { return 0.5f * (lower + upper); }
    Vec3 size() const { return upper - lower; }
    void include(Vec3 const& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
};

} // namespace framelet
