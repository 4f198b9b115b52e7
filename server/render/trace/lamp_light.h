// Adds the light that surfaces reflect of punctual lights. In: sixteen surfaces. Out: radiance.
#pragma once

#include "server/render/light/brdf.h"
#include "server/render/packet.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/surface/surface.h"

namespace framelet {

inline constexpr std::uint32_t no_light = ~0u;

/// The light of which each lane would get most if nothing were in its way.
struct StrongestLight {
    LaneFloats most; ///< luminance
    LaneIndices lost; ///< its number where it is blocked, else `no_light`
};

/// So many lights have exact shadows in every scene. Of more, those of which a packet reflects most have.
inline constexpr std::size_t exact_lights = 16;
/// Rays a lane that tell what share of the other lights' shine arrives.
inline constexpr int rays_to_others = 4;

/// Adds what each lane of `lit` reflects. Up to `exact_lights` + `rays_to_others` lights have a shadow each. In scenes
/// of more the strongest have, and the rest together has the shadow of a sample of it: every lane looks at four, each
/// in proportion to what comes from it, all lanes of a plane together at 64 (importance sampling of many lights
/// [Shirley 1996], with fixed strata, so that it does not flicker). `is_plane`: as of `find_shadow`. `strongest` is set
/// only where something in the scene moves. Returns how many rays that took.
std::uint32_t add_lights(PreparedScene const& scene, SurfacePacket const& surfaces, LobePacket const& lobes,
                         LaneMask lit, bool is_plane, StrongestLight& strongest, LaneVec3& radiance);

} // namespace framelet
