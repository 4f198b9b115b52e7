// What is asked of paths of light.
#pragma once

#include <cstdint>

#include "server/render/light/lamp_sizes.h"

namespace framelet {

/// By which rays light with a size (lamps, emissive triangles, environment) is found. All agree in the mean.
enum class LightRays { both, to_lights, by_surface };

class LightCache;

struct PathOptions {
    int paths = 64; ///< of each sample
    std::uint32_t seed = 0;
    LampSizes sizes{};
    LightRays light_rays = LightRays::both;
    int sure_bounces = 4; ///< after which roulette begins to end paths
    /// Where what is gathered comes from surfaces of which this knows the light in this pose of its own, paths end
    /// there. Null: no path does.
    LightCache const* known = nullptr;
    std::uint32_t known_pose = 0;
    bool lambertian = false; ///< surfaces reflect base colour * (1 - metallic) and have no gloss: for known answers
};

} // namespace framelet
