// Sixteen rays side by side: the unit that is traced and shaded. Each component has an array of its own, so that a
// plain loop over the lanes becomes vector instructions.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "common/math.h"

namespace framelet {

/// Number of lanes of a packet: 4x4 neighbouring samples of a framelet.
inline constexpr int lanes = 16;

/// A set of lanes: bit i is set where lane i takes part.
using LaneMask = std::uint32_t;
inline constexpr LaneMask all_lanes = (1u << lanes) - 1;

struct alignas(64) LaneFloats {
    float lane[lanes];

    float& operator[](int i) { return lane[i]; }
    float operator[](int i) const { return lane[i]; }
    void fill(float value) {
        for (float& f : lane) {
            f = value;
        }
    }
};

struct alignas(64) LaneIndices {
    std::uint32_t lane[lanes];

    std::uint32_t& operator[](int i) { return lane[i]; }
    std::uint32_t operator[](int i) const { return lane[i]; }
};

struct LaneVec3 {
    LaneFloats x, y, z;

    Vec3 get(int i) const { return {x[i], y[i], z[i]}; }
    void set(int i, Vec3 const& value) {
        x[i] = value.x;
        y[i] = value.y;
        z[i] = value.z;
    }
    void fill(Vec3 const& value) {
        x.fill(value.x);
        y.fill(value.y);
        z.fill(value.z);
    }
};

/// Calls `visit(lane)` for each set bit, lowest first.
template <class Visit>
void for_each_lane(LaneMask mask, Visit&& visit) {
    for (; mask != 0; mask &= mask - 1) {
        visit(std::countr_zero(mask));
    }
}

/// Mask of the lanes for which `test(lane)` holds; written without branches so that it vectorises.
template <class Test>
LaneMask lanes_where(Test&& test) {
    LaneMask mask = 0;
    for (int i = 0; i < lanes; ++i) {
        mask |= static_cast<LaneMask>(test(i) ? 1u : 0u) << i;
    }
    return mask;
}

/// No element of the inverse of an instance's transform reaches 1 / this.
inline constexpr float least_instance_scale = 1e-7f;
/// True where a ray can start: no coordinate reaches 1e10 metres. The BVH squares coordinates, in single precision and
/// in the space of instances that may be scaled down (to `least_instance_scale`).
inline bool traceable(Vec3 const& position) {
    constexpr float most = 1e10f;
    return std::abs(position.x) < most && std::abs(position.y) < most && std::abs(position.z) < most;
}

/// Rays: the points origin + t * direction for near < t < far. Directions need not have unit length.
struct RayPacket {
    LaneVec3 origin, direction;
    LaneFloats near, far;
};

/// Hits of rays, `t` being the ray parameter. Barycentric (u, v) weigh a triangle's second and third corner.
struct HitPacket {
    LaneFloats t, u, v;
    LaneIndices triangle, geometry, instance;
};

/// Width of the cone that a sample covers, world units: constant + slope * t.
struct Footprint {
    LaneFloats width, slope;
    LaneFloats pixels; ///< how many such a width is in the picture; for the light cache
    bool is_block = false; ///< the lanes are 4x4 neighbours, in Morton order
};

} // namespace framelet
