// Finds how fast the shadows of what moves pass over what does not. In: traced packets. Out: velocities of a framelet's
// samples, as of what deforms: a viewer then moves the shadow and not the surface that it lies on.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/light/light.h"
#include "server/render/trace/tracing.h"

namespace framelet {

/// Velocity, metres a second, of a shadow on a plane of unit normal `facet`: that of a point which moves with velocity
/// `occluder` and lies `distance` metres from where its shadow falls, in the unit direction `to_light`. It lies in the
/// plane. It is 0 where light grazes the plane, and where the shadow would be too slow or too fast to be worth
/// following.
Vec3 shadow_velocity(RenderLight const& light, Vec3 const& facet, Vec3 const& to_light, float distance_to_light,
                     float distance, Vec3 const& occluder);

/// Adds velocities of shadows to the lanes of a packet, samples `first` .. `first` + 15 of the framelet: to those on
/// static surfaces that have lost their strongest light to something that moves, and to nothing that does not. Returns
/// how many rays that took: one for each lane that is static and has lost its light.
std::uint32_t add_shadow_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out);

} // namespace framelet
