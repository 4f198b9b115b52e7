// Vector helpers that survive degenerate input, for importing.
// In: any finite vectors. Out: finite vectors.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "common/math.h"

namespace framelet {

inline bool is_finite(Vec3 const& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool is_finite(Vec4 const& v) {
    return is_finite(Vec3(v)) && std::isfinite(v.w);
}

/// Unit vector along `v`, or `otherwise` where `v` has no direction. Works for any length a float can hold.
inline Vec3 unit_or(Vec3 v, Vec3 const& otherwise) {
    float const square = glm::dot(v, v);
    if (square > 1e-30f && square < 1e30f) {
        return v * (1 / std::sqrt(square));
    }
    float const largest = std::fmax(std::abs(v.x), std::fmax(std::abs(v.y), std::abs(v.z)));
    if (!(largest > 0) || !std::isfinite(largest)) {
        return otherwise;
    }
    v /= largest;
    return glm::normalize(v);
}

/// The quaternion with unit length, or no rotation where it has no length.
inline Quat unit_rotation(Quat const& q) {
    float const length = glm::length(q);
    return length > 0 ? q / length : Quat(1, 0, 0, 0);
}

/// Some unit vector at right angles to the unit vector `n`.
inline Vec3 any_perpendicular(Vec3 const& n) {
    Vec3 const axis = std::abs(n.x) < 0.7f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return glm::normalize(axis - n * glm::dot(axis, n));
}

/// Angle between the edges from `corner` to `a` and to `b`, radians; 0 where one has no length.
inline float corner_angle(Vec3 const& corner, Vec3 const& a, Vec3 const& b) {
    Vec3 const u = unit_or(a - corner, Vec3(0));
    Vec3 const v = unit_or(b - corner, Vec3(0));
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

} // namespace framelet
