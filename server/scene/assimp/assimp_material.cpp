#include <algorithm>
#include <map>
#include <utility>

#include <assimp/material.h>
#include <assimp/scene.h>

#include "server/scene/assimp/assimp_parts.h"
#include "server/scene/assimp/picture_ops.h"
#include "server/scene/reading/image_loading.h"
#include "server/scene/reading/named_file.h"

namespace framelet {
namespace {

/// Collects the images that materials name: each once, whatever the number of uses.
struct Images {
    aiScene const& from;
    SceneFolder const& folder;
    ImportBudget& budget;
    std::vector<std::string>& warnings;
    std::vector<EncodedImage> encoded;
    std::map<std::string, Index> index_of;

    /// Makes a picture of an embedded texture that is stored as texels.
    Picture make_picture(aiTexture const& texture) const {
        budget.reserve(std::uint64_t(texture.mWidth) * texture.mHeight, 4);
        Picture picture(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight));
        for (std::size_t i = 0; i < picture.rgba.size() / 4; ++i) {
            aiTexel const& texel = texture.pcData[i];
            std::uint8_t const rgba[4] = {texel.r, texel.g, texel.b, texel.a};
            std::copy_n(rgba, 4, &picture.rgba[i * 4]);
        }
        return picture;
    }

    Index add(std::string const& name) {
        auto const [found, added] = index_of.try_emplace(name, static_cast<Index>(encoded.size()));
        if (added) {
            EncodedImage image{name, {}, {}, nullptr, {}};
            aiTexture const* const embedded = from.GetEmbeddedTexture(name.c_str());
            if (embedded && embedded->mHeight == 0) {
                image.bytes =
                    std::as_bytes(std::span(reinterpret_cast<char const*>(embedded->pcData), embedded->mWidth));
                image.name += std::string(".") + embedded->achFormatHint;
            } else if (embedded) {
                image.decoded = std::make_shared<Picture const>(make_picture(*embedded));
            } else {
                NamedFile const file = find_named_file(folder, "image", name);
                image.file = file.file;
                image.problem = file.file.empty() ? no_named_file(folder, "image", name) : "";
                if (!file.remark.empty()) {
                    warnings.push_back(file.remark);
                }
            }
            encoded.push_back(std::move(image));
        }
        return found->second;
    }
};

/// Puts a transform of coordinates whose v goes upwards (scaled, turned about the middle, moved) into `use`, of
/// coordinates whose v goes downwards.
void set_transform(TextureUse& use, aiUVTransform const& from) {
    Vec2 const scale(from.mScaling.x, from.mScaling.y);
    float const sine = std::sin(from.mRotation);
    float const cosine = std::cos(from.mRotation);
    Vec2 const corner = Vec2(0, 1) * scale - 0.5f; // what (0, 0) is with v upwards, seen from the middle
    use.scale = scale;
    use.rotation = from.mRotation;
    use.offset = Vec2(0.5f + cosine * corner.x - sine * corner.y + from.mTranslation.x,
                      0.5f - sine * corner.x - cosine * corner.y - from.mTranslation.y);
}

Wrap wrap_of(aiTextureMapMode mode) {
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? Wrap::clamp
           : mode == aiTextureMapMode_Mirror                                ? Wrap::mirror
                                                                            : Wrap::repeat;
}

struct MaterialReader {
    aiMaterial const& from;
    bool is_on_colors; ///< of vertices
    Images& images;
    Scene& scene;

    float number(char const* key, unsigned type, unsigned index, float otherwise) const {
        float value = otherwise;
        return from.Get(key, type, index, value) == aiReturn_SUCCESS ? value : otherwise;
    }

    bool has(char const* key, unsigned type, unsigned index) const {
        float value = 0;
        return from.Get(key, type, index, value) == aiReturn_SUCCESS;
    }

    Vec3 color(char const* key, unsigned type, unsigned index, Vec3 const& otherwise) const {
        aiColor3D value; // which becomes black where there is none
        return from.Get(key, type, index, value) == aiReturn_SUCCESS ? Vec3(value.r, value.g, value.b) : otherwise;
    }

    /// The first texture of the first of the types that the material has.
    TextureUse texture(std::initializer_list<aiTextureType> types) {
        TextureUse use;
        for (aiTextureType const type : types) {
            aiString path;
            unsigned uv_set = 0;
            aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
            if (from.GetTexture(type, 0, &path, nullptr, &uv_set, nullptr, nullptr, modes) != aiReturn_SUCCESS ||
                path.length == 0) {
                continue;
            }
            Texture texture;
            texture.image = images.add(path.C_Str());
            texture.wrap_u = wrap_of(modes[0]);
            texture.wrap_v = wrap_of(modes[1]);
            use.texture = static_cast<Index>(scene.textures.size());
            use.uv_set = static_cast<int>(std::min(uv_set, 1u));
            aiUVTransform transform;
            if (from.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS) {
                set_transform(use, transform);
            }
            scene.textures.push_back(texture);
            break;
        }
        return use;
    }

    /// Roughness whose microfacets have the highlight of a Blinn-Phong exponent: alpha^2 = 2 / (n + 2) ([Walter 2007]),
    /// alpha = roughness^2.
    float roughness() const {
        Vec3 const specular = color(AI_MATKEY_COLOR_SPECULAR, Vec3(0));
        float const exponent = number(AI_MATKEY_SHININESS, 0);
        bool const shines = std::max({specular.x, specular.y, specular.z}) > 0 && exponent > 0;
        return shines ? std::pow(2 / (exponent + 2), 0.25f) : 1.0f;
    }

    Material read() {
        Material material;
        aiString name;
        from.Get(AI_MATKEY_NAME, name);
        material.name = name.C_Str();
        material.double_sided = true; // these formats say nothing of it, and their faces are often wound either way
        bool const physical = has(AI_MATKEY_METALLIC_FACTOR) || has(AI_MATKEY_ROUGHNESS_FACTOR);
        material.metallic = number(AI_MATKEY_METALLIC_FACTOR, 0);
        material.roughness = physical ? number(AI_MATKEY_ROUGHNESS_FACTOR, 1) : roughness();
        material.base_color_texture = texture({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
        material.emissive_texture = texture({aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
        material.normal_texture = texture({aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_HEIGHT});
        bool const textured = material.base_color_texture.texture != none;
        Vec3 diffuse = color(AI_MATKEY_COLOR_DIFFUSE, Vec3(textured ? 1.0f : 0.6f));
        if (physical) {
            diffuse = color(AI_MATKEY_BASE_COLOR, diffuse);
        }
        if (is_on_colors && material.name == AI_DEFAULT_MATERIAL_NAME) { // Assimp's grey, not the file's
            diffuse = Vec3(1);
        }
        if (textured && diffuse == Vec3(0)) { // written by programs for which a texture replaces the colour
            diffuse = Vec3(1);
        }
        float const opacity = number(AI_MATKEY_OPACITY, 1);
        material.base_color = Vec4(diffuse, opacity);
        material.alpha_mode = opacity < 1 ? AlphaMode::blend : AlphaMode::opaque;
        material.emissive = color(AI_MATKEY_COLOR_EMISSIVE, Vec3(0)) * number(AI_MATKEY_EMISSIVE_INTENSITY, 1);
        if (material.emissive_texture.texture != none && material.emissive == Vec3(0)) {
            material.emissive = Vec3(1);
        }
        return material;
    }
};

Index image_of(Scene const& scene, TextureUse const& use) {
    return use.texture == none ? none : scene.textures[static_cast<std::size_t>(use.texture)].image;
}

/// Moves a separate opacity map into the alpha of the base colour, where glTF materials have it.
void apply_opacity(Scene& scene, Material& material, TextureUse const& opacity, ImportBudget& budget,
                   std::map<std::pair<Index, Index>, Index>& merged) {
    Index const mask = image_of(scene, opacity);
    if (mask == none || !scene.images[static_cast<std::size_t>(mask)]) {
        return;
    }
    Index const base = image_of(scene, material.base_color_texture);
    auto const [found, added] = merged.try_emplace({base, mask}, static_cast<Index>(scene.images.size()));
    Picture const* const color = base == none ? nullptr : scene.images[static_cast<std::size_t>(base)].get();
    if (added) { // 40 pictures of each kind make 1600 of both
        Picture const& alpha = *scene.images[static_cast<std::size_t>(mask)];
        budget.reserve((color == nullptr ? alpha : *color).rgba.size(), 1);
        scene.images.push_back(std::make_shared<Picture const>(with_opacity(color, alpha)));
    }
    Texture texture =
        scene.textures[static_cast<std::size_t>(base == none ? opacity.texture : material.base_color_texture.texture)];
    texture.image = found->second;
    if (base == none) {
        material.base_color_texture = opacity;
    }
    material.base_color_texture.texture = static_cast<Index>(scene.textures.size());
    scene.textures.push_back(texture);
    if (material.alpha_mode == AlphaMode::opaque) {
        material.alpha_mode =
            is_cutout(*scene.images[static_cast<std::size_t>(found->second)]) ? AlphaMode::mask : AlphaMode::blend;
    }
}

} // namespace

void import_assimp_materials(aiScene const& from, SceneFolder const& folder, ImportBudget& budget, Scene& scene,
                             Progress const& progress) {
    Images images{from, folder, budget, scene.warnings, {}, {}};
    std::vector<TextureUse> opacity;
    std::vector<bool> is_on_colors(from.mNumMaterials);
    for (unsigned m = 0; m < from.mNumMeshes; ++m) {
        if (from.mMeshes[m]->mColors[0]) {
            is_on_colors[from.mMeshes[m]->mMaterialIndex] = true;
        }
    }
    for (unsigned i = 0; i < from.mNumMaterials; ++i) {
        MaterialReader reader{*from.mMaterials[i], is_on_colors[i], images, scene};
        scene.materials.push_back(reader.read());
        opacity.push_back(reader.texture({aiTextureType_OPACITY}));
    }
    scene.images = load_images(images.encoded, folder, budget, scene.warnings, progress);
    std::map<std::pair<Index, Index>, Index> merged;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        Index const normal = image_of(scene, material.normal_texture);
        if (normal != none && scene.images[static_cast<std::size_t>(normal)] &&
            !is_normal_map(*scene.images[static_cast<std::size_t>(normal)])) {
            scene.warnings.push_back("bump map '" + images.encoded[static_cast<std::size_t>(normal)].name +
                                     "' holds heights, not normals; shown without it");
            material.normal_texture = {};
        }
        apply_opacity(scene, material, opacity[i], budget, merged);
    }
}

} // namespace framelet
