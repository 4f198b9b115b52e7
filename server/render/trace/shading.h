// Computes the light that leaves surfaces towards the viewer: emission, light from all around, punctual lights with
// shadows. It also says which mirror reflections that takes, and what they are worth; they are traced elsewhere.
#pragma once

#include "server/render/light/brdf.h"
#include "server/render/packet.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/surface/surface.h"
#include "server/render/trace/lamp_light.h"
#include "server/render/trace/surrounding_light.h"

namespace framelet {

struct ShadedPacket {
    LaneVec3 radiance; ///< of the surface, already weighed by its alpha
    LaneVec3 passed; ///< share of what lies behind that is seen through it; set only where the scene is see-through
    /// Number of the light of which a lane would get most, where something opaque blocks that; else `no_light`. Set
    /// only where something in the scene moves.
    LaneIndices lost_light;
    /// Luminance of the irradiance / pi from all around, and what share of the radiance comes from there; set only
    /// where the scene has a light cache.
    LaneFloats light, light_share;
    LaneMask reflects; ///< lanes for which a mirror reflection was traced
    std::uint32_t segments; ///< rays traced for it
};

/// Mirror reflections that are to be traced: whoever traces adds `share` of the light that they bring.
struct MirrorRays {
    RayPacket rays;
    Footprint footprint;
    LaneVec3 share;
    LaneMask lanes = 0;
};

/// The lanes of `active` are shaded in two halves, between which mirror reflections are added to `out`. The first half
/// gives `lobes` for the second, emission and the light from all around. `may_reflect`: light may be followed once
/// more.
void shade_surroundings(PreparedScene const& scene, SurfacePacket const& surfaces, SurroundingLight const& around,
                        LaneMask active, bool may_reflect, LobePacket& lobes, MirrorRays& mirror, ShadedPacket& out);
/// The second half adds punctual lights with their shadows, and weighs all of it. `is_plane`: as of `find_shadow`.
void shade_lights(PreparedScene const& scene, SurfacePacket const& surfaces, LaneMask active, LobePacket const& lobes,
                  bool is_plane, ShadedPacket& out);

} // namespace framelet
