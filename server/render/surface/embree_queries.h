// Traces packets of rays through Embree's scenes, in Embree's packets of eight or sixteen. In: rays, the scenes. Out:
// which lanes hit, and what.
#pragma once

#include "server/render/packet.h"
#include "server/render/surface/embree_filters.h"

namespace framelet {

/// The scenes that are traced: one, or two as if they were one.
struct TopLevels {
    RTCScene first;
    RTCScene second; ///< null: there is none
    bool sixteen_wide; ///< whether the processor traces sixteen rays at a time
};

/// Finds the nearest hit of each active lane, and returns the lanes that hit. Without a `filter` of the query's own,
/// rays are taken to be coherent; `moving` is for `note_moving`.
LaneMask intersect_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, RTCFilterFunctionN filter,
                          MovingHits* moving, HitPacket& hits);
/// Returns the active lanes that are stopped; `attenuate_shadow` multiplies `transmittance`.
LaneMask occlude_packet(TopLevels const& levels, RayPacket const& rays, LaneMask active, LaneVec3& transmittance);

} // namespace framelet
