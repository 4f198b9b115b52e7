// Turns hits into surfaces: interpolated attributes, textures filtered over the sample's footprint, normal mapping. In:
// rays and what they met. Out: what shading needs, sixteen lanes at a time, all of it finite.
#pragma once

#include "server/render/packet.h"
#include "server/render/surface/geometry.h"

namespace framelet {

struct SurfacePacket {
    LaneVec3 position; ///< world, from the triangle's corners rather than along the ray: more digits
    /// Where rays that leave this surface start, world: off the triangle, and off the facet of a smooth mesh.
    LaneVec3 leaving;
    LaneVec3 geometric_normal; ///< unit, on the viewer's side
    LaneVec3 normal; ///< unit shading normal, bent so that the viewer is above it
    LaneVec3 view; ///< unit, towards the viewer
    LaneVec3 base_color, emissive;
    LaneFloats alpha; ///< 1 for opaque surfaces and for what is left of cut-outs
    LaneFloats metallic, roughness, occlusion, transmission;
    LaneFloats width; ///< of the footprint there, world units
    LaneFloats spread; ///< what the footprint gains in width per world unit of distance
    LaneMask unlit = 0;
};

/// Fills `out` for the lanes of `hit`. Returns the lanes whose surface is there for this ray: those that meet a
/// single-sided material from behind are left out, and those so far out that no ray can start there.
LaneMask make_surfaces(std::span<Instance const> instances, RayPacket const& rays, HitPacket const& hits, LaneMask hit,
                       Footprint const& footprint, SurfacePacket& out);

/// A start for rays that leave `position` to the side of `normal`, far enough off to miss the surface itself and no
/// farther than single precision asks for ([Wächter 2019]). `largest`: of the numbers that `position` was computed of,
/// metres.
Vec3 offset_from_surface(Vec3 const& position, Vec3 const& normal, float largest);

} // namespace framelet
