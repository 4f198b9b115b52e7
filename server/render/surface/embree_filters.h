// Filters by which Embree decides which surfaces on a ray's way count as hits; it calls them for each that it finds.
// In: the surfaces found. Out: `valid` of each lane, 0 where the ray goes on.
#pragma once

#include <span>

#include "server/render/packet.h"
#include "server/render/surface/embree_api.h"
#include "server/render/surface/geometry.h"

namespace framelet {

/// A query's hits on instances that move: the first and the last of each lane of `met`.
struct MovingHits {
    std::span<Instance const> instances; ///< by number
    HitPacket& nearest;
    HitPacket& farthest;
    LaneMask met = 0;
};

/// Context that Embree hands through to the filters; its own part must stand first.
struct QueryContext {
    EmbreeContext embree;
    LaneVec3* transmittance = nullptr;
    MovingHits* moving = nullptr;
};

/// Lets rays pass where a surface is cut out.
void reject_cut_out(RTCFilterFunctionNArguments const* args);
/// Lets rays pass single-sided surfaces that are met from behind.
void reject_behind(RTCFilterFunctionNArguments const* args);
/// Lets rays pass what lets light through and all else that moves, of which `QueryContext::moving` gets the first and
/// the last hit.
void note_moving(RTCFilterFunctionNArguments const* args);
/// Multiplies `QueryContext::transmittance` by what the surface lets pass, and lets the ray pass while more than 1/1000
/// is left.
void attenuate_shadow(RTCFilterFunctionNArguments const* args);

} // namespace framelet
