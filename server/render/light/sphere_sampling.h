// What sampling of directions is made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "common/math.h"

namespace framelet {

/// An orthonormal basis whose third vector is the unit vector `n` ([Duff 2017]).
inline Mat3 frame_about(Vec3 const& n) {
    float const s = std::copysign(1.0f, n.z);
    float const a = -1 / (s + n.z);
    float const b = n.x * n.y * a;
    return Mat3(Vec3(1 + s * n.x * n.x * a, s * b, -s * n.x), Vec3(b, s + n.y * n.y * a, -n.y), n);
}

/// Solid angle of the directions whose angle to an axis has at most this sine and is no wider than 90 degrees, sr.
inline float cone_angle(float sine) {
    float const cosine = std::sqrt(std::max(0.0f, 1 - sine * sine));
    return 2 * std::numbers::pi_v<float> * sine * sine / (1 + cosine); // 1 - cos without its loss of digits
}

/// A unit direction about `axis`, even in the solid angle of the cone, sr.
inline Vec3 sample_cone(Vec3 const& axis, float angle, Vec2 random) {
    constexpr float turn = 2 * std::numbers::pi_v<float>;
    float const lowered = random.x * angle / turn; // 1 - cosine
    float const sine = std::sqrt(std::max(0.0f, lowered * (2 - lowered)));
    return frame_about(axis) * Vec3(sine * std::cos(turn * random.y), sine * std::sin(turn * random.y), 1 - lowered);
}

inline std::uint32_t reversed_bits(std::uint32_t bits) {
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
    bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
    return ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
}

/// A fraction of [0, 1) from the upper bits.
inline float unit_fraction(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

} // namespace framelet
