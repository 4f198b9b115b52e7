// Finds how the shadows of what moves pass over what does not. In: traced packets. Out: drifts of a framelet's
// samples, as of what deforms: a viewer then moves the shadow and not the surface that it lies on.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/light/light.h"
#include "server/render/trace/tracing.h"

namespace framelet {

/// Where the shadow of a point falls on a plane through `on` of unit normal `facet`, metres in the world. Not finite,
/// or anywhere, where light grazes the plane.
Vec3 shadow_of(Vec3 const& point, RenderLight const& light, Vec3 const& on, Vec3 const& facet);

/// Adds drifts of shadows to the lanes of a packet, samples `first` .. `first` + 15 of the framelet: to those on
/// static surfaces that have lost their strongest light to something that moves, and to nothing that does not. Returns
/// how many rays that took: one for each lane that is static and has lost its light.
std::uint32_t add_shadow_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out);

} // namespace framelet
