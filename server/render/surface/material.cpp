#include "server/render/surface/material.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include <tbb/parallel_for.h>

namespace framelet {
namespace {

using ChainKey = std::pair<Index, TexelKind>;

bool usable(Scene const& scene, TextureUse const& use) {
    if (use.texture < 0 || use.texture >= static_cast<Index>(scene.textures.size())) {
        return false;
    }
    Index const image = scene.textures[static_cast<std::size_t>(use.texture)].image;
    if (image < 0 || image >= static_cast<Index>(scene.images.size())) {
        return false;
    }
    auto const& picture = scene.images[static_cast<std::size_t>(image)];
    return picture && picture->width > 0 && picture->height > 0;
}

TexelKind base_color_kind(Material const& material) {
    return material.alpha_mode == AlphaMode::opaque ? TexelKind::color : TexelKind::color_alpha;
}

/// Every texture use of a material with the meaning of its texels, in one fixed order.
template <class Visit>
void for_each_use(Material const& m, RenderMaterial& out, Visit&& visit) {
    visit(m.base_color_texture, base_color_kind(m), out.base_color_map);
    visit(m.metallic_roughness_texture, TexelKind::linear, out.metallic_roughness_map);
    visit(m.normal_texture, TexelKind::linear, out.normal_map);
    visit(m.occlusion_texture, TexelKind::linear, out.occlusion_map);
    visit(m.emissive_texture, TexelKind::color, out.emissive_map);
    visit(m.transmission_texture, TexelKind::linear, out.transmission_map);
}

RenderMaterial with_factors(Material const& m) {
    RenderMaterial out;
    out.base_color = glm::clamp(m.base_color, Vec4(0), Vec4(1));
    out.emissive = glm::max(m.emissive, Vec3(0));
    out.metallic = std::clamp(m.metallic, 0.0f, 1.0f);
    out.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    out.normal_scale = m.normal_scale;
    out.occlusion_strength = std::clamp(m.occlusion_strength, 0.0f, 1.0f);
    out.transmission = std::clamp(m.transmission, 0.0f, 1.0f);
    out.alpha_cutoff = m.alpha_cutoff;
    out.alpha_mode = m.alpha_mode;
    out.double_sided = m.double_sided;
    out.unlit = m.unlit;
    return out;
}

} // namespace

MaterialLibrary make_materials(Scene const& scene, Progress const& progress) {
    std::map<ChainKey, MipChain const*> chains;
    RenderMaterial unused;
    for (Material const& material : scene.materials) {
        for_each_use(material, unused, [&](TextureUse const& use, TexelKind kind, TextureSampler&) {
            if (usable(scene, use)) {
                chains[{scene.textures[static_cast<std::size_t>(use.texture)].image, kind}] = nullptr;
            }
        });
    }

    std::vector<ChainKey> keys;
    keys.reserve(chains.size());
    for (auto const& entry : chains) {
        keys.push_back(entry.first);
    }
    std::vector<std::optional<MipChain>> built(keys.size());
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t(0), keys.size(), [&](std::size_t i) {
        built[i].emplace(scene.images[static_cast<std::size_t>(keys[i].first)], keys[i].second);
        if (progress) {
            std::scoped_lock const lock(report);
            progress("preparing textures", static_cast<double>(++done) / static_cast<double>(keys.size()));
        }
    });

    MaterialLibrary library;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        library.chains.push_back(std::move(*built[i]));
        chains[keys[i]] = &library.chains.back();
    }
    for (Material const& material : scene.materials) {
        RenderMaterial out = with_factors(material);
        for_each_use(material, out, [&](TextureUse const& use, TexelKind kind, TextureSampler& sampler) {
            if (usable(scene, use)) {
                Texture const& texture = scene.textures[static_cast<std::size_t>(use.texture)];
                sampler = TextureSampler(*chains[{texture.image, kind}], texture, use);
                out.uses_uv = true;
            }
        });
        out.occlusion_in_roughness_map = out.occlusion_map && out.metallic_roughness_map &&
                                         out.occlusion_map.same_lookup(out.metallic_roughness_map);
        library.materials.push_back(out);
    }
    library.materials.push_back(with_factors(Material{}));
    return library;
}

} // namespace framelet
