// What sampling of directions is made of.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/math.h"

namespace framelet {

/// An orthonormal basis whose third vector is the unit vector `n` ([Duff 2017]).
inline Mat3 frame_about(Vec3 const& n) {
    float const s = std::copysign(1.0f, n.z);
    float const a = -1 / (s + n.z);
    float const b = n.x * n.y * a;
    return Mat3(Vec3(1 + s * n.x * n.x * a, s * b, -s * n.x), Vec3(b, s + n.y * n.y * a, -n.y), n);
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
