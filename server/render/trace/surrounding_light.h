// Light that arrives at surfaces from all around, but from punctual lights: of the environment, or of the light cache
// where the scene has one. In: surfaces. Out: what shading weighs.
#pragma once

#include "server/render/packet.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/surface/surface.h"

namespace framelet {

struct SurroundingLight {
    LaneVec3 diffuse; ///< irradiance / pi about the shading normal
    LaneVec3 specular; ///< radiance averaged over the lobe of the roughness
    bool is_plane = false; ///< the lanes are known to be 4x4 neighbours on one plane
};

/// The mirror direction of a lane's view, unit.
Vec3 mirrored(SurfacePacket const& surfaces, int lane);

/// Fills `out` for the lanes of `lit`. `footprint`: by which the surfaces were found.
void find_surrounding_light(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& surfaces,
                            LaneMask lit, Footprint const& footprint, SurroundingLight& out);

} // namespace framelet
