// Packets of rays through Embree's scenes, in packets of its own of eight or sixteen. In: rays, the scenes. Out: which
// lanes hit, and what.
#pragma once

#include "server/render/packet.h"
#include "server/render/surface/embree_filters.h"

namespace framelet {

/// What is traced: one scene or two, as if it were one.
struct TopLevels {
    RTCScene first;
    RTCScene second; ///< null: there is none
    bool sixteen_wide; ///< whether the processor traces sixteen rays at a time
};

/// Nearest hit of each active lane, and returns the lanes that hit. Without a `filter` of the query's own, rays are
/// taken to be coherent; `moving` is for `note_moving`.
LaneMask intersect_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, RTCFilterFunctionN filter,
                          MovingHits* moving, HitPacket& hits);
/// Returns the active lanes that are stopped; `transmittance` as `attenuate_shadow`.
LaneMask occlude_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, LaneVec3& transmittance);

} // namespace framelet
