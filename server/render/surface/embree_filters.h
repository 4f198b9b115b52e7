// Which of the surfaces on a ray's way count as hits: what Embree calls for each that it finds. In: what is found. Out:
// `valid` of its lane, 0 where the ray goes on.
#pragma once

#include <span>

#include "server/render/packet.h"
#include "server/render/surface/embree_api.h"
#include "server/render/surface/geometry.h"

namespace framelet {

/// What a query finds of instances that move.
struct MovingHits {
    std::span<Instance const> instances; ///< by number
    HitPacket& nearest;
    HitPacket& farthest;
    LaneMask met = 0;
};

/// Handed through Embree to the filters; its context must stand first.
struct QueryContext {
    EmbreeContext embree;
    LaneVec3* transmittance = nullptr;
    MovingHits* moving = nullptr;
};

/// Passes cut-outs.
void reject_cut_out(RTCFilterFunctionNArguments const* args);
/// Passes single-sided surfaces that are met from behind.
void reject_behind(RTCFilterFunctionNArguments const* args);
/// Passes all that moves, of which `QueryContext::moving` gets the first and the last, and what lets light through.
void note_moving(RTCFilterFunctionNArguments const* args);
/// Multiplies `QueryContext::transmittance` by what the surface lets pass, and passes it while that is anything.
void attenuate_shadow(RTCFilterFunctionNArguments const* args);

} // namespace framelet
