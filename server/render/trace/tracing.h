// Traces rays: nearest surfaces are shaded and composited front to back. In: rays. Out: radiance and depth.
#pragma once

#include "server/render/packet.h"
#include "server/render/prepared/prepared_scene.h"

namespace framelet {

inline constexpr std::uint32_t no_instance = ~0u;

struct TracedPacket {
    LaneVec3 radiance; ///< finite, >= 0
    LaneFloats depth; ///< ray parameter of the surface that contributes most; +infinity where that is the background
    HitPacket surface; ///< that surface, where something in the scene moves; instance `no_instance`: the background
    /// The light that the same surface has lost to a shadow (as in `ShadedPacket`), likewise only where something
    /// moves; in lanes that have lost one, where rays leave the surface and the unit normal of its triangle.
    LaneIndices lost_light;
    LaneVec3 leaving, facet;
    LaneFloats light, light_share; ///< of the surface that gives the depth, as in `ShadedPacket`; 0: of the background
    LaneMask reflects = 0; ///< lanes that show a traced mirror reflection
    std::uint32_t segments = 0; ///< rays traced for it, shadow and mirror rays included
};

/// Moves the start of rays that go on in the same direction: just behind a see-through surface (`passed`), and from
/// just before one that is seen from behind (`culled`), since many files put a second triangle the other way round into
/// the same place.
void continue_behind(HitPacket const& hits, LaneMask passed, LaneMask culled, RayPacket& rays);

/// Traces the lanes of `active`; the others are left as they are. `rays.near` is moved along where rays continue.
void trace(PreparedScene const& scene, RayPacket& rays, LaneMask active, Footprint const& footprint, int bounces,
           TracedPacket& out);

} // namespace framelet
