#include "server/scene/gltf/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace framelet {
namespace {

constexpr std::array<std::string_view, 12> known_extensions{
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",    "EXT_texture_webp",
    "KHR_lights_punctual",     "KHR_draco_mesh_compression", "KHR_materials_emissive_strength",
    "KHR_materials_unlit",     "KHR_materials_transmission", "KHR_mesh_quantization",
    "KHR_meshopt_compression", "KHR_node_visibility",        "KHR_texture_transform"};

/// What a file lacks of which an extension is not read.
struct Loss {
    std::string_view extension;
    char const* what; ///< "... are missing"
    bool in_part = false; ///< the rest of it is read
};

constexpr std::array losses{
    Loss{"KHR_animation_pointer", "what it animates (materials, lights, visibility) stands still"},
    Loss{"KHR_materials_anisotropy", "highlights are round where they should be long"},
    Loss{"KHR_materials_clearcoat", "clear coats are missing"},
    Loss{"KHR_materials_diffuse_transmission", "light that shines through thin things is missing"},
    Loss{"KHR_materials_dispersion", "colours of refraction are missing"},
    Loss{"KHR_materials_ior", "reflections are as strong as those of glass"},
    Loss{"KHR_materials_iridescence", "colours of thin films are missing"},
    Loss{"KHR_materials_pbrSpecularGlossiness", "diffuse colours are shown, specular colours are missing", true},
    Loss{"KHR_materials_sheen", "the sheen of cloth is missing"},
    Loss{"KHR_materials_specular", "reflections have their usual strength and colour"},
    Loss{"KHR_materials_variants", "things show as in the first variant alone"},
    Loss{"KHR_materials_volume", "glass is thin and does not bend light"},
    Loss{"KHR_texture_basisu", "textures in KTX2 are missing: there is no decoder of Basis Universal"},
    Loss{"MSFT_lod", "the finest level of detail is shown alone"},
    Loss{"MSFT_texture_dds", "textures in DDS are missing"},
};

/// Extensions that add nothing that could be seen.
constexpr std::array<std::string_view, 4> nothing_to_see{"KHR_xmp_json_ld", "KHR_xmp", "KHR_audio_emitter",
                                                         "EXT_mesh_features"};

std::set<std::string> names(Json const& json, char const* key) {
    std::set<std::string> out;
    for (Json const& name : list(json, key)) {
        if (name.is_string()) {
            out.insert(name.get<std::string>());
        }
    }
    return out;
}

bool is_read(std::string_view name) {
    return std::ranges::find(known_extensions, name) != known_extensions.end() ||
           std::ranges::find(nothing_to_see, name) != nothing_to_see.end();
}

} // namespace

std::string note_extensions(Json const& json, std::vector<std::string>& remarks) {
    std::set<std::string> const required = names(json, "extensionsRequired");
    std::set<std::string> used = names(json, "extensionsUsed");
    used.insert(required.begin(), required.end());
    std::string lacks;
    for (std::string const& name : used) {
        if (is_read(name)) {
            continue;
        }
        auto const* const loss = std::ranges::find(losses, name, &Loss::extension);
        remarks.push_back("extension " + name +
                          " is not read: " + (loss == losses.end() ? "what it adds is missing" : loss->what));
        if (required.contains(name)) {
            lacks += (lacks.empty() ? "it requires the extension " : ", ") + name;
        }
    }
    return lacks.empty() ? lacks : lacks + ", which is not read";
}

} // namespace framelet
