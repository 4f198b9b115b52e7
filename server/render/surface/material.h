// Materials ready for look-up: factors and samplers side by side, and what kind of surface they make.
#pragma once

#include <deque>
#include <vector>

#include "server/render/surface/texture.h"
#include "server/scene/reading/progress.h"

namespace framelet {

struct RenderMaterial {
    Vec4 base_color{1};
    Vec3 emissive{0};
    float metallic = 1;
    float roughness = 1;
    float normal_scale = 1;
    float occlusion_strength = 1;
    float transmission = 0;
    float alpha_cutoff = 0.5f;
    AlphaMode alpha_mode = AlphaMode::opaque;
    bool double_sided = false;
    bool unlit = false;
    bool occlusion_in_roughness_map = false; ///< one look-up serves both
    bool uses_uv = false; ///< has a map of any kind
    TextureSampler base_color_map, metallic_roughness_map, normal_map, occlusion_map, emissive_map, transmission_map;

    /// True where light goes straight through in part: the ray continues behind it, shadows are attenuated.
    bool see_through() const { return alpha_mode == AlphaMode::blend || transmission > 0; }
};

/// Every material of a scene, and the mip chains they share.
struct MaterialLibrary {
    std::deque<MipChain> chains; ///< samplers point into it
    std::vector<RenderMaterial> materials; ///< one a scene material, then a default one
};

/// Builds a mip chain for each use of an image that a material needs. The library shares the scene's pictures and needs
/// the scene no more.
MaterialLibrary make_materials(Scene const& scene, Progress const& progress = {});

} // namespace framelet
