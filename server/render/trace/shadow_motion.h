// How fast shadows of what moves pass over what does not. In: traced packets. Out: velocities of a framelet's samples,
// as of what deforms: a viewer then moves the shadow and not the surface that it lies on.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/light/light.h"
#include "server/render/trace/tracing.h"

namespace framelet {

/// With what velocity, metres a second, a shadow passes over a plane of unit normal `facet`: that of a point which
/// moves with `occluder` and lies `distance` metres from where its shadow falls, in the unit direction `to_light`. It
/// stays in the plane. 0 where light grazes the plane, and where it would be faster than anything that is worth
/// following.
Vec3 shadow_velocity(RenderLight const& light, Vec3 const& facet, Vec3 const& to_light, float distance_to_light,
                     float distance, Vec3 const& occluder);

/// Adds to the packet's lanes, samples `first` .. `first` + 15 of the framelet, that lie on what does not move and have
/// lost the light of which they would get most to something that does, and to nothing that does not. Returns how many
/// rays that took: one for each lane that is static and has lost its light.
std::uint32_t add_shadow_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out);

} // namespace framelet
