#include "server/scene/gltf/gltf_import.h"

#include <algorithm>
#include <mutex>
#include <optional>

#include <tbb/parallel_for.h>

#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_file.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/motion/animation.h"
#include "server/scene/reading/faults.h"
#include "server/scene/reading/memory_limit.h"

namespace framelet {
namespace {

/// The file's scenes by number and name, but for the one `without`.
std::string scenes_of(Json const& json, std::size_t without) {
    constexpr std::size_t most = 20;
    Json::array_t const& scenes = list(json, "scenes");
    std::string out;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        std::string const name = text(scenes[i], "name");
        if (i != without && i < most) {
            out += (out.empty() ? "" : ", ") + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
        }
    }
    return out + (scenes.size() > most ? ", ..." : "");
}

/// The scene of that name or else number; where none is wanted the one that the file says, with a remark on others.
/// 0 where the file has none.
std::size_t chosen_scene(Json const& json, std::string const& wanted, std::vector<std::string>& remarks) {
    Json::array_t const& scenes = list(json, "scenes");
    std::string const known = scenes.empty() ? "it has none" : "it has " + scenes_of(json, scenes.size());
    if (wanted.empty()) {
        Index const said = member(json, "scene").is_null() ? 0 : index(json, "scene");
        auto const place = static_cast<std::size_t>(said);
        if (!scenes.empty() && place >= scenes.size()) {
            throw InputError("scene " + member(json, "scene").dump() +
                             ", which it wants to be shown, does not exist; " + known + " (--scene chooses one)");
        }
        if (scenes.size() > 1) {
            remarks.push_back(named("scene", place, text(scenes[place], "name")) +
                              " is shown; --scene shows another: " + scenes_of(json, place));
        }
        return scenes.empty() ? 0 : place;
    }
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (text(scenes[i], "name") == wanted) {
            return i;
        }
    }
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (std::to_string(i) == wanted) {
            return i;
        }
    }
    throw InputError("there is no scene '" + wanted + "' in it; " + known);
}

bool uses_draco(Json const& json) {
    auto const is_compressed = [](Json const& primitive) {
        return !extension(primitive, "KHR_draco_mesh_compression").is_null();
    };
    return std::ranges::any_of(list(json, "meshes"), [&](Json const& mesh) {
        return std::ranges::any_of(list(mesh, "primitives"), is_compressed);
    });
}

void append(std::vector<std::string>& to, std::vector<std::string> const& lines) {
    to.insert(to.end(), lines.begin(), lines.end());
}

} // namespace

Scene import_gltf(std::filesystem::path const& path, SceneFolder const& folder, ImportBudget& budget,
                  std::string const& wanted_scene, std::span<std::string const> needed_clips, bool is_checked,
                  Progress const& progress) {
    Scene scene;
    std::vector<std::string> faults;
    progress("reading", 0);
    auto const file = read_gltf(path, folder, budget, scene.warnings, faults, progress);
    scene.is_truncated = file->is_truncated;
    Json const& json = file->json;
    GltfAccessors const accessors(*file, budget);
    progress("reading", 1);

    std::size_t const chosen = chosen_scene(json, wanted_scene, scene.warnings);
    import_gltf_materials(json, scene, faults);
    GltfMapping const mapping = import_gltf_nodes(json, chosen, accessors, budget, scene, faults);
    import_gltf_animations(json, accessors, mapping.node, scene, faults);
    clips_named(scene, needed_clips);

    std::size_t const mesh_count = mapping.used_meshes.size();
    ImportBudget forecast = budget;
    for (std::size_t const mesh : mapping.used_meshes) {
        reserve_gltf_mesh(json, accessors, mesh, forecast);
    }
    std::optional<MemoryLimit> limit; // Draco takes memory without asking
    if (!is_checked && uses_draco(json)) {
        limit.emplace(budget.left());
    }
    std::vector<GltfMesh> meshes(mesh_count);
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t(0), mesh_count, [&](std::size_t i) {
        meshes[i] = import_gltf_mesh(json, accessors, mapping.used_meshes[i]);
        std::lock_guard const lock(report);
        progress("unpacking meshes", static_cast<double>(++done) / static_cast<double>(mesh_count));
    });
    limit.reset();
    for (GltfMesh& mesh : meshes) {
        append(scene.warnings, mesh.remarks);
        append(faults, mesh.faults);
        scene.meshes.push_back(std::move(mesh.mesh));
    }
    if (!faults.empty() &&
        std::ranges::all_of(scene.meshes, [](Mesh const& mesh) { return mesh.primitives.empty(); })) {
        throw InputError((file->lacks.empty() ? "" : file->lacks + "; ") + faults.front());
    }
    append(scene.warnings, faults);

    auto const images = gltf_images(*file, accessors, folder, budget, scene.warnings);
    scene.images = load_images(images, folder, budget, scene.warnings, progress);
    if (Json::array_t const& scenes = list(json, "scenes"); !scenes.empty()) {
        scene.name = text(scenes[chosen], "name");
    }
    scene.light = text(member(member(json, "asset"), "extras"), "framelet_light");
    return scene;
}

} // namespace framelet
