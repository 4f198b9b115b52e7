// Light that leaves surfaces towards the viewer: emission, environment, punctual lights with shadows, reflections.
#pragma once

#include "server/render/packet.h"
#include "server/render/prepared_scene.h"
#include "server/render/surface.h"

namespace framelet {

inline constexpr std::uint32_t no_light = ~0u;

struct ShadedPacket {
    LaneVec3 radiance; ///< of the surface, already weighed by its alpha
    LaneVec3 passed; ///< share of what lies behind that is seen through it; set only where the scene is see-through
    /// Number of the light of which a lane would get most, where something opaque blocks that; else `no_light`. Set
    /// only where something in the scene moves.
    LaneIndices lost_light;
    LaneMask reflects; ///< lanes for which a mirror reflection was traced
    std::uint32_t segments; ///< rays traced for it
};

/// Shades the lanes of `active`. `bounces`: how often light may still be followed along mirror reflections.
void shade(PreparedScene const& scene, SurfacePacket const& surfaces, LaneMask active, int bounces, ShadedPacket& out);

} // namespace framelet
