// Finds how much of a light's shine gets to sixteen points, hard or, of a light with a size, through a penumbra. In:
// the points, the light, what would arrive. Out: the share of it that does.
#pragma once

#include "server/render/light/light.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/surface/surface.h"

namespace framelet {

/// Shadow rays end after this share of the way to a light: the lamp's own surface casts no shadow.
inline constexpr float shadow_ray_share = 0.999f;

/// Sets `passed` to the share, per colour, that gets to each lane of `reached`; returns those that get nothing. A hard
/// light takes one ray a lane. One with a size takes one to another point of it from each lane, and only where some of
/// these are blocked, as in a penumbra, three more. `is_plane`: the lanes are 4x4 neighbours in Morton order on one
/// plane, so that a penumbra that is wide there is made smooth. Counts rays in `segments`.
LaneMask find_shadow(PreparedScene const& scene, RenderLight const& light, SurfacePacket const& surfaces,
                     ArrivingLight const& arriving, LaneMask reached, bool is_plane, LaneVec3& passed,
                     std::uint32_t& segments);

} // namespace framelet
