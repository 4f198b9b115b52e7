#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/gltf/gltf_value.h"

namespace framelet {
namespace {

Wrap wrap_of(int mode) {
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::mirror;
    default:
        return Wrap::repeat;
    }
}

Texture make_texture(tinygltf::Model const& model, tinygltf::Texture const& from) {
    Texture texture;
    texture.image = from.source;
    if (tinygltf::Value const* webp = find_extension(from.extensions, "EXT_texture_webp")) {
        texture.image = integer(*webp, "source", texture.image);
    }
    if (texture.image < 0 || static_cast<std::size_t>(texture.image) >= model.images.size()) {
        texture.image = none;
    }
    if (from.sampler >= 0 && static_cast<std::size_t>(from.sampler) < model.samplers.size()) {
        tinygltf::Sampler const& sampler = model.samplers[static_cast<std::size_t>(from.sampler)];
        texture.wrap_u = wrap_of(sampler.wrapS);
        texture.wrap_v = wrap_of(sampler.wrapT);
        texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    return texture;
}

TextureUse make_use(Scene& scene, int index, int uv_set, tinygltf::Value const* transform) {
    TextureUse use;
    if (index < 0) {
        return use;
    }
    if (static_cast<std::size_t>(index) >= scene.textures.size()) {
        scene.warnings.push_back("texture " + std::to_string(index) + " does not exist; shown without it");
        return use;
    }
    use.texture = index;
    use.uv_set = uv_set;
    if (transform) {
        use.offset = vec2(*transform, "offset", use.offset);
        use.scale = vec2(*transform, "scale", use.scale);
        use.rotation = number(*transform, "rotation", 0);
        use.uv_set = integer(*transform, "texCoord", uv_set);
    }
    if (use.uv_set < 0 || use.uv_set > 1) {
        scene.warnings.push_back("texture coordinate set " + std::to_string(use.uv_set) +
                                 " is not supported; set 0 is used");
        use.uv_set = 0;
    }
    return use;
}

template <class Info>
TextureUse make_use(Scene& scene, Info const& info) {
    return make_use(scene, info.index, info.texCoord, find_extension(info.extensions, "KHR_texture_transform"));
}

void add_transmission(Scene& scene, tinygltf::Value const& extension, Material& material) {
    material.transmission = number(extension, "transmissionFactor", 0);
    tinygltf::Value const& texture = extension.Get("transmissionTexture");
    if (texture.IsObject()) {
        tinygltf::Value const& extensions = texture.Get("extensions");
        tinygltf::Value const* const transform =
            extensions.Has("KHR_texture_transform") && extensions.Get("KHR_texture_transform").IsObject()
                ? &extensions.Get("KHR_texture_transform")
                : nullptr;
        material.transmission_texture =
            make_use(scene, integer(texture, "index", none), integer(texture, "texCoord", 0), transform);
    }
}

Material make_material(Scene& scene, tinygltf::Material const& from) {
    Material material;
    tinygltf::PbrMetallicRoughness const& pbr = from.pbrMetallicRoughness;
    material.name = from.name;
    material.base_color = vec4(pbr.baseColorFactor, material.base_color);
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.emissive = vec3(from.emissiveFactor, material.emissive);
    material.normal_scale = static_cast<float>(from.normalTexture.scale);
    material.occlusion_strength = static_cast<float>(from.occlusionTexture.strength);
    material.alpha_cutoff = static_cast<float>(from.alphaCutoff);
    material.alpha_mode = from.alphaMode == "MASK"    ? AlphaMode::mask
                          : from.alphaMode == "BLEND" ? AlphaMode::blend
                                                      : AlphaMode::opaque;
    material.double_sided = from.doubleSided;
    material.base_color_texture = make_use(scene, pbr.baseColorTexture);
    material.metallic_roughness_texture = make_use(scene, pbr.metallicRoughnessTexture);
    material.normal_texture = make_use(scene, from.normalTexture);
    material.occlusion_texture = make_use(scene, from.occlusionTexture);
    material.emissive_texture = make_use(scene, from.emissiveTexture);
    material.unlit = from.extensions.contains("KHR_materials_unlit");
    if (auto const* strength = find_extension(from.extensions, "KHR_materials_emissive_strength")) {
        material.emissive *= number(*strength, "emissiveStrength", 1);
    }
    if (auto const* transmission = find_extension(from.extensions, "KHR_materials_transmission")) {
        add_transmission(scene, *transmission, material);
    }
    return material;
}

} // namespace

void import_gltf_materials(tinygltf::Model const& model, Scene& scene) {
    for (tinygltf::Texture const& texture : model.textures) {
        scene.textures.push_back(make_texture(model, texture));
    }
    for (tinygltf::Material const& material : model.materials) {
        scene.materials.push_back(make_material(scene, material));
    }
}

} // namespace framelet
