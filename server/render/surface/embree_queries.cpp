#include "server/render/surface/embree_queries.h"

#include <cstring>
#include <type_traits>

namespace framelet {
namespace {

template <class Visit>
void for_each_scene(TopLevels const& levels, Visit const& visit) {
    visit(levels.first);
    if (levels.second) {
        visit(levels.second);
    }
}

/// Copies `count` lanes from `first` on into Embree's layout of that many.
template <class RayN, int count>
void load_rays(RayPacket const& rays, int first, RayN& out) {
    constexpr std::size_t bytes = sizeof(float) * count;
    std::memcpy(out.org_x, rays.origin.x.lane + first, bytes);
    std::memcpy(out.org_y, rays.origin.y.lane + first, bytes);
    std::memcpy(out.org_z, rays.origin.z.lane + first, bytes);
    std::memcpy(out.dir_x, rays.direction.x.lane + first, bytes);
    std::memcpy(out.dir_y, rays.direction.y.lane + first, bytes);
    std::memcpy(out.dir_z, rays.direction.z.lane + first, bytes);
    std::memcpy(out.tnear, rays.near.lane + first, bytes);
    std::memcpy(out.tfar, rays.far.lane + first, bytes);
    for (int i = 0; i < count; ++i) {
        out.time[i] = 0;
        out.mask[i] = ~0u;
        out.id[i] = static_cast<unsigned>(first + i);
        out.flags[i] = 0;
    }
}

/// Rays that Embree cannot trace (it checks, and aborts the process) are not handed to it: they meet nothing.
template <int count>
bool valid_lanes(RayPacket const& rays, LaneMask active, int first, int* valid) {
    if (((active >> first) & ((1u << count) - 1)) == 0) {
        return false;
    }
    for (int i = 0; i < count; ++i) {
        int const lane = first + i;
        bool const wanted = (active >> lane & 1) != 0;
        valid[i] = -(int{wanted} & int{traceable(rays.origin.get(lane))} & int{traceable(rays.direction.get(lane))});
    }
    return true;
}

template <int count>
LaneMask intersect_lanes(TopLevels const& levels, RayPacket const& rays, LaneMask active, int first,
                         RTCFilterFunctionN filter, MovingHits* moving, HitPacket& hits) {
    alignas(64) int valid[count];
    if (!valid_lanes<count>(rays, active, first, valid)) {
        return 0;
    }
    std::conditional_t<count == 16, RTCRayHit16, RTCRayHit8> found;
    load_rays<decltype(found.ray), count>(rays, first, found.ray);
    for (int i = 0; i < count; ++i) {
        found.hit.u[i] = found.hit.v[i] = 0;
        found.hit.primID[i] = 0;
        found.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        found.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    QueryContext context;
    context.moving = moving;
    EmbreeQuery const query{context.embree, filter == nullptr, filter};
    begin_query(query);
    for_each_scene(levels, [&](RTCScene scene) { intersect(query, valid, scene, found); });
    LaneMask hit = 0;
    for (int i = 0; i < count; ++i) {
        hits.t[first + i] = found.ray.tfar[i];
        hits.u[first + i] = found.hit.u[i];
        hits.v[first + i] = found.hit.v[i];
        hits.triangle[first + i] = found.hit.primID[i];
        hits.geometry[first + i] = found.hit.geomID[i];
        hits.instance[first + i] = found.hit.instID[0][i];
        bool const met = valid[i] != 0 && found.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hit |= static_cast<LaneMask>(met ? 1u : 0u) << (first + i);
    }
    return hit;
}

template <int count>
LaneMask occluded_lanes(TopLevels const& levels, RayPacket const& rays, LaneMask active, int first,
                        LaneVec3& transmittance) {
    alignas(64) int valid[count];
    if (!valid_lanes<count>(rays, active, first, valid)) {
        return 0;
    }
    std::conditional_t<count == 16, RTCRay16, RTCRay8> segments;
    load_rays<decltype(segments), count>(rays, first, segments);
    QueryContext context;
    context.transmittance = &transmittance;
    LaneMask blocked = 0;
    auto const leave_out_blocked = [&] {
        for (int i = 0; i < count; ++i) {
            bool const met = valid[i] != 0 && segments.tfar[i] < 0; // -infinity marks a hit
            blocked |= static_cast<LaneMask>(met ? 1u : 0u) << (first + i);
            valid[i] = met ? 0 : valid[i];
        }
    };
    // Embree 3's 16-wide coherent occlusion was seen not to return on instanced scenes under AVX-512.
    EmbreeQuery const query{context.embree, count != 16};
    begin_query(query);
    for_each_scene(levels, [&](RTCScene scene) {
        occlude(query, valid, scene, segments);
        leave_out_blocked();
    });
    return blocked;
}

} // namespace

LaneMask intersect_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, RTCFilterFunctionN filter,
                          MovingHits* moving, HitPacket& hits) {
    if (levels.sixteen_wide) {
        return intersect_lanes<16>(levels, rays, active, 0, filter, moving, hits);
    }
    return intersect_lanes<8>(levels, rays, active, 0, filter, moving, hits) |
           intersect_lanes<8>(levels, rays, active, 8, filter, moving, hits);
}

LaneMask occlude_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, LaneVec3& transmittance) {
    if (levels.sixteen_wide) {
        return occluded_lanes<16>(levels, rays, active, 0, transmittance);
    }
    return occluded_lanes<8>(levels, rays, active, 0, transmittance) |
           occluded_lanes<8>(levels, rays, active, 8, transmittance);
}

} // namespace framelet
