// Finds what carries the samples of a framelet: bodies by number, and velocities where nothing rigid does. In: traced
// packets. Out: a framelet's bodies and velocities, which stay empty where nothing moves.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/trace/tracing.h"

namespace framelet {

/// Velocity of the point of `instance` that a lane has met, world metres a second.
Vec3 velocity_at(Instance const& instance, HitPacket const& hits, int lane);

/// Adds the motion of the packet's lanes, samples `first` .. `first` + 15 of the framelet.
void add_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out);

} // namespace framelet
