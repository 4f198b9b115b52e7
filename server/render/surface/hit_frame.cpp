#include "server/render/surface/hit_frame.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

constexpr float shortest_squared = 1e-30f, longest_squared = 1e30f; // of a vector that still has a direction

/// Data of each lane that is read from the mesh, in the mesh's own space.
struct ObjectSpace {
    LaneVec3 corner, edge1, edge2, normal;
    LaneFloats u, v;
};

void gather(std::span<Instance const> instances, HitPacket const& hits, LaneMask hit, ObjectSpace& object,
            HitFrame& out) {
    for_each_lane(hit, [&](int lane) {
        std::size_t const i = static_cast<std::size_t>(lane);
        Instance const& instance = instances[hits.instance[lane]];
        Geometry const& geometry = instance.geometries[hits.geometry[lane]];
        TrianglePoint const point = point_of(geometry, hits.triangle[lane], hits.u[lane], hits.v[lane]);
        Vec3 const corner = geometry.positions[point.corner[0]];
        object.corner.set(lane, corner);
        object.edge1.set(lane, geometry.positions[point.corner[1]] - corner);
        object.edge2.set(lane, geometry.positions[point.corner[2]] - corner);
        object.normal.set(lane, geometry.normals.empty() ? Vec3(0) : point.interpolate(geometry.normals));
        out.instance[i] = &instance;
        out.geometry[i] = &geometry;
        out.point[i] = point;
    });
}

/// to = matrix * from (+ offset) for the lanes of `mask`; the others keep what they have.
void transform(Mat3 const& m, Vec3 const& offset, LaneVec3 const& from, LaneFloats const& mask, LaneVec3& to) {
    for (int i = 0; i < lanes; ++i) {
        float const x = from.x[i], y = from.y[i], z = from.z[i];
        bool const take = mask[i] != 0;
        to.x[i] = take ? m[0].x * x + m[1].x * y + m[2].x * z + offset.x : to.x[i];
        to.y[i] = take ? m[0].y * x + m[1].y * y + m[2].y * z + offset.y : to.y[i];
        to.z[i] = take ? m[0].z * x + m[1].z * y + m[2].z * z + offset.z : to.z[i];
    }
}

/// Transforms hits into the world, one instance after the other: a packet rarely meets more than two.
void to_world(ObjectSpace const& object, LaneMask hit, LaneFloats& handedness, HitFrame& out) {
    LaneVec3 point;
    for (int i = 0; i < lanes; ++i) {
        point.x[i] = object.corner.x[i] + object.edge1.x[i] * object.u[i] + object.edge2.x[i] * object.v[i];
        point.y[i] = object.corner.y[i] + object.edge1.y[i] * object.u[i] + object.edge2.y[i] * object.v[i];
        point.z[i] = object.corner.z[i] + object.edge1.z[i] * object.u[i] + object.edge2.z[i] * object.v[i];
    }
    while (hit != 0) {
        Instance const* const instance = out.instance[static_cast<std::size_t>(std::countr_zero(hit))];
        LaneFloats mask;
        mask.fill(0);
        LaneMask same = 0;
        for_each_lane(hit, [&](int lane) {
            if (out.instance[static_cast<std::size_t>(lane)] == instance) {
                mask[lane] = 1;
                handedness[lane] = instance->handedness;
                same |= 1u << lane;
            }
        });
        transform(instance->linear, instance->translation, point, mask, out.position);
        transform(instance->linear, Vec3(0), object.edge1, mask, out.edge1);
        transform(instance->linear, Vec3(0), object.edge2, mask, out.edge2);
        transform(instance->normal_matrix, Vec3(0), object.normal, mask, out.normal);
        hit &= ~same;
    }
}

/// Normalises in place; lanes without a direction take that of `instead` times `sign`.
void normalize_or(LaneVec3& value, LaneVec3 const& instead, float sign) {
    for (int i = 0; i < lanes; ++i) {
        float const x = value.x[i], y = value.y[i], z = value.z[i];
        float const squared = x * x + y * y + z * z;
        bool const directed = (squared > shortest_squared) & (squared < longest_squared);
        float const scale = 1 / std::sqrt(directed ? squared : 1.0f);
        value.x[i] = directed ? x * scale : instead.x[i] * sign;
        value.y[i] = directed ? y * scale : instead.y[i] * sign;
        value.z[i] = directed ? z * scale : instead.z[i] * sign;
    }
}

/// Facet normals on the viewer's side; returns the lanes met from behind.
LaneMask make_facets(LaneFloats const& handedness, HitFrame& out) {
    for (int i = 0; i < lanes; ++i) {
        float const x = out.edge1.y[i] * out.edge2.z[i] - out.edge1.z[i] * out.edge2.y[i];
        float const y = out.edge1.z[i] * out.edge2.x[i] - out.edge1.x[i] * out.edge2.z[i];
        float const z = out.edge1.x[i] * out.edge2.y[i] - out.edge1.y[i] * out.edge2.x[i];
        float const squared = x * x + y * y + z * z;
        out.inverse_determinant[i] = squared > shortest_squared ? 1 / squared : 0.0f;
        out.facet.x[i] = x * handedness[i];
        out.facet.y[i] = y * handedness[i];
        out.facet.z[i] = z * handedness[i];
    }
    normalize_or(out.facet, out.ray, -1);
    normalize_or(out.normal, out.facet, 1);
    LaneFloats along;
    for (int i = 0; i < lanes; ++i) {
        along[i] = out.facet.x[i] * out.ray.x[i] + out.facet.y[i] * out.ray.y[i] + out.facet.z[i] * out.ray.z[i];
        float const sign = along[i] > 0 ? -1.0f : 1.0f;
        out.facet.x[i] *= sign;
        out.facet.y[i] *= sign;
        out.facet.z[i] *= sign;
    }
    return lanes_where([&](int i) { return along[i] > 0; });
}

} // namespace

Vec3 unit_or(Vec3 const& value, Vec3 const& instead) {
    float const squared = glm::dot(value, value);
    return squared > shortest_squared && squared < longest_squared ? value * (1 / std::sqrt(squared)) : instead;
}

LaneMask make_hit_frames(std::span<Instance const> instances, RayPacket const& rays, HitPacket const& hits,
                         LaneMask hit, HitFrame& out) {
    ObjectSpace object{};
    object.u = hits.u;
    object.v = hits.v;
    gather(instances, hits, hit, object, out);
    LaneFloats handedness;
    handedness.fill(1);
    to_world(object, hit, handedness, out);
    LaneVec3 ahead;
    ahead.fill({0, 0, -1});
    out.ray = rays.direction;
    normalize_or(out.ray, ahead, 1);
    out.behind = hit & make_facets(handedness, out);
    LaneMask present = 0;
    for_each_lane(hit, [&](int lane) {
        bool const culled =
            (out.behind >> lane & 1) != 0 && !out.geometry[static_cast<std::size_t>(lane)]->material->double_sided;
        present |= static_cast<LaneMask>(!culled && traceable(out.position.get(lane)) ? 1u : 0u) << lane;
    });
    return present;
}

Vec3 smooth_offset(HitFrame const& frame, int lane) {
    std::size_t const i = static_cast<std::size_t>(lane);
    Geometry const& geometry = *frame.geometry[i];
    TrianglePoint const& point = frame.point[i];
    if (geometry.normals.empty()) {
        return Vec3(0);
    }
    Vec3 const normals[3] = {geometry.normals[point.corner[0]], geometry.normals[point.corner[1]],
                             geometry.normals[point.corner[2]]};
    if (normals[0] == normals[1] && normals[1] == normals[2]) {
        return Vec3(0); // flat, as most large things are
    }
    Mat3 const& linear = frame.instance[i]->linear;
    Vec3 const facet = frame.facet.get(lane) * linear; // its covector in the mesh's own space
    Vec3 const at = point.interpolate(geometry.positions);
    float const least = 0.25f * glm::dot(facet, facet); // within 60 degrees
    float const weights[3] = {point.w, point.u, point.v};
    Vec3 offset(0);
    for (std::size_t k = 0; k < 3; ++k) {
        float const agreement = glm::dot(normals[k], facet);
        if (!(agreement * agreement > least * glm::dot(normals[k], normals[k]))) {
            return Vec3(0);
        }
        Vec3 const n = agreement < 0 ? -normals[k] : normals[k];
        float const below = std::min(0.0f, glm::dot(at - geometry.positions[point.corner[k]], n));
        offset -= n * (below * weights[k]);
    }
    return linear * offset;
}

} // namespace framelet
