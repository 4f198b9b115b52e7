#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/reading/faults.h"

namespace framelet {
namespace {

/// Numbers of the specification (glTF 2.0 section 5.26).
constexpr int clamp_to_edge = 33071, mirrored_repeat = 33648, nearest = 9728;

Wrap wrap_of(Index mode) {
    return mode == clamp_to_edge ? Wrap::clamp : mode == mirrored_repeat ? Wrap::mirror : Wrap::repeat;
}

Texture make_texture(Json const& json, Json const& from, Faults const& faults) {
    Texture texture;
    Json const& webp = member(extension(from, "EXT_texture_webp"), "source");
    Json const& source = webp.is_null() ? member(from, "source") : webp;
    if (!source.is_null()) {
        faults.tried([&] { texture.image = static_cast<Index>(checked(source, list(json, "images").size(), "image")); },
                     "; things show without it");
    }
    Json::array_t const& samplers = list(json, "samplers");
    Index const sampler = index(from, "sampler");
    if (sampler >= 0 && static_cast<std::size_t>(sampler) < samplers.size()) {
        Json const& how = samplers[static_cast<std::size_t>(sampler)];
        texture.wrap_u = wrap_of(index(how, "wrapS"));
        texture.wrap_v = wrap_of(index(how, "wrapT"));
        texture.nearest = index(how, "magFilter") == nearest;
    }
    return texture;
}

/// Reads the parts of one material. What cannot be read keeps its default.
class MaterialReader {
public:
    MaterialReader(std::size_t textures, Faults faults) : textures_(textures), faults_(std::move(faults)) {}

    template <typename T>
    void read(Json const& object, char const* key, T& out) const {
        faults_.tried([&] { read_numbers(object, key, out); }, "; its usual value is taken");
    }

    TextureUse use(Json const& object, char const* key) const {
        Json const& info = member(object, key);
        TextureUse use;
        if (!info.is_object() ||
            !faults_.tried(
                [&] { use.texture = static_cast<Index>(checked(member(info, "index"), textures_, "texture")); },
                "; it is shown without it")) {
            return use;
        }
        Json const& transform = extension(info, "KHR_texture_transform");
        read(transform, "offset", use.offset);
        read(transform, "scale", use.scale);
        use.rotation = static_cast<float>(number(transform, "rotation", 0));
        Index const set = index(transform, "texCoord") == none ? index(info, "texCoord") : index(transform, "texCoord");
        if (set > 1) {
            faults_.note("texture coordinate set " + std::to_string(set) + " is not supported; set 0 is used");
        }
        use.uv_set = set == 1 ? 1 : 0;
        return use;
    }

private:
    std::size_t textures_;
    Faults faults_;
};

/// Takes what specular-glossiness says of diffuse colours, where metallic-roughness says nothing of them. What it says
/// of highlights has no place here.
void read_specular_glossiness(Json const& from, MaterialReader const& reader, Material& material) {
    reader.read(from, "diffuseFactor", material.base_color);
    material.base_color_texture = reader.use(from, "diffuseTexture");
    material.metallic = 0;
    bool const varies = member(from, "specularGlossinessTexture").is_object(); // which is not read
    material.roughness = varies ? 1.0f : 1 - static_cast<float>(number(from, "glossinessFactor", 1));
}

Material make_material(Json const& from, MaterialReader const& reader) {
    Material material;
    Json const& pbr = member(from, "pbrMetallicRoughness");
    auto const factor = [](Json const& object, char const* key, float otherwise) {
        return static_cast<float>(number(object, key, otherwise));
    };
    material.name = text(from, "name");
    reader.read(pbr, "baseColorFactor", material.base_color);
    material.metallic = factor(pbr, "metallicFactor", material.metallic);
    material.roughness = factor(pbr, "roughnessFactor", material.roughness);
    reader.read(from, "emissiveFactor", material.emissive);
    material.normal_scale = factor(member(from, "normalTexture"), "scale", material.normal_scale);
    material.occlusion_strength = factor(member(from, "occlusionTexture"), "strength", material.occlusion_strength);
    material.alpha_cutoff = factor(from, "alphaCutoff", material.alpha_cutoff);
    std::string const alpha_mode = text(from, "alphaMode");
    material.alpha_mode = alpha_mode == "MASK"    ? AlphaMode::mask
                          : alpha_mode == "BLEND" ? AlphaMode::blend
                                                  : AlphaMode::opaque;
    material.double_sided = flag(from, "doubleSided", false);
    material.base_color_texture = reader.use(pbr, "baseColorTexture");
    material.metallic_roughness_texture = reader.use(pbr, "metallicRoughnessTexture");
    Json const& glossy = extension(from, "KHR_materials_pbrSpecularGlossiness");
    if (!glossy.is_null() && member(pbr, "baseColorFactor").is_null() && member(pbr, "baseColorTexture").is_null()) {
        read_specular_glossiness(glossy, reader, material);
    }
    material.normal_texture = reader.use(from, "normalTexture");
    material.occlusion_texture = reader.use(from, "occlusionTexture");
    material.emissive_texture = reader.use(from, "emissiveTexture");
    material.unlit = !extension(from, "KHR_materials_unlit").is_null();
    material.emissive *= factor(extension(from, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    Json const& transmission = extension(from, "KHR_materials_transmission");
    material.transmission = factor(transmission, "transmissionFactor", material.transmission);
    material.transmission_texture = reader.use(transmission, "transmissionTexture");
    return material;
}

} // namespace

void import_gltf_materials(Json const& json, Scene& scene, std::vector<std::string>& faults) {
    for (Json const& texture : list(json, "textures")) {
        scene.textures.push_back(make_texture(json, texture, {named("texture", scene.textures.size(), ""), faults}));
    }
    for (Json const& material : list(json, "materials")) {
        std::string const what = named("material", scene.materials.size(), text(material, "name"));
        scene.materials.push_back(make_material(material, {scene.textures.size(), {what, faults}}));
    }
}

} // namespace framelet
