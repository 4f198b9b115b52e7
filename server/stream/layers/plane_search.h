// Finds the plane on which most of some samples lie, however the others are scattered. In: values on a framelet's grid,
// candidates, tolerance. Out: a plane and its members.
#pragma once

#include "server/stream/layers/plane_fit.h"

namespace framelet {

struct FoundPlane {
    GridPlane plane;
    GridFloats members; ///< 1 for samples that lie on it, else 0; not set where there are none
    int count = 0; ///< of members
};

/// Fewer samples than this make no plane.
inline constexpr int least_plane_samples = 8;

/// Finds the plane within `tolerance` of (nearly) the most candidates (those of non-zero weight): of all of them where
/// that is possible; else grown from 4x4 blocks that are planar by themselves; else from what is left when those
/// farthest off are dropped again and again. A count of 0 where none takes `least_plane_samples`.
void find_plane(GridFloats const& values, GridFloats const& candidates, float tolerance, FoundPlane& found);

} // namespace framelet
