// Makes a packet of rays through points of a picture. In: a camera's rays, the point that each lane looks at. Out: a
// packet to trace.
#pragma once

#include "common/camera.h"
#include "server/render/packet.h"

namespace framelet {

/// The rays through `position(lane)`: the point of the image plane that this lane looks at, pixels.
template <class Position>
RayPacket rays_through(ViewRays const& view, Position&& position) {
    RayPacket rays;
    for (int i = 0; i < lanes; ++i) {
        Vec2 const p = position(i);
        rays.origin.set(i, view.origin + view.origin_dx * p.x + view.origin_dy * p.y);
        rays.direction.set(i, view.direction + view.direction_dx * p.x + view.direction_dy * p.y);
    }
    rays.near.fill(0);
    rays.far.fill(INFINITY);
    return rays;
}

} // namespace framelet
