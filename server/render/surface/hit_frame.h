// The geometric part of a hit: which triangle, where on it, and its frame in the world, for sixteen rays at a time.
// In: rays and what they met. Out: points, edges and normals; nothing of the material but whether it has two sides.
#pragma once

#include <array>

#include "server/render/packet.h"
#include "server/render/surface/geometry.h"

namespace framelet {

/// A point of a triangle: corners and their weights.
struct TrianglePoint {
    std::array<std::uint32_t, 3> corner;
    float w, u, v;

    template <class T>
    T interpolate(std::span<T const> values) const {
        return values[corner[0]] * w + values[corner[1]] * u + values[corner[2]] * v;
    }
    template <class T>
    T interpolate(std::vector<T> const& values) const {
        return interpolate(std::span<T const>(values));
    }
};

inline TrianglePoint point_of(Geometry const& geometry, std::uint32_t triangle, float u, float v) {
    return {geometry.source->triangles[triangle], 1 - u - v, u, v};
}

/// `value` as a unit vector, or `instead` where it has no direction.
Vec3 unit_or(Vec3 const& value, Vec3 const& instead);

struct HitFrame {
    std::array<Geometry const*, lanes> geometry;
    std::array<Instance const*, lanes> instance;
    std::array<TrianglePoint, lanes> point;
    LaneVec3 position; ///< world, from the corners rather than along the ray: more digits
    LaneVec3 edge1, edge2; ///< world, from the first corner
    LaneVec3 facet; ///< unit normal of the triangle, on the viewer's side
    LaneVec3 normal; ///< unit, interpolated from the corners, on the mesh's own side
    LaneVec3 ray; ///< unit direction of the ray
    LaneFloats inverse_determinant; ///< of the edges' Gram matrix; 0 for slivers
    LaneMask behind = 0; ///< met from behind
};

/// Fills `out` for the lanes of `hit`. Returns the lanes whose surface is there for this ray: those that meet a
/// single-sided material from behind are left out, and those so far out that no ray can start there.
LaneMask make_hit_frames(std::span<Instance const> instances, RayPacket const& rays, HitPacket const& hits,
                         LaneMask hit, HitFrame& out);

/// Offset from a lane's point to where a smooth mesh would be: onto the mean of its corners' tangent planes
/// ([Hanika 2021]). Facets then do not shadow themselves along the terminator. Corner normals far off the facet's own
/// (foliage, flat signs) say nothing about its shape and move nothing.
Vec3 smooth_offset(HitFrame const& frame, int lane);

} // namespace framelet
