#include "server/scene/gltf/gltf_import.h"

#include <mutex>

#include <tbb/parallel_for.h>
#include <tiny_gltf.h>

#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_file.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/motion/animation.h"

namespace framelet {

Scene import_gltf(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                  std::span<std::string const> needed_clips, Progress const& progress) {
    Scene scene;
    progress("reading", 0);
    auto const model = read_gltf(file, folder, budget, scene.warnings, progress);
    GltfAccessors const accessors(*model, budget);
    progress("reading", 1);

    import_gltf_materials(*model, scene);
    GltfMapping const mapping = import_gltf_nodes(*model, accessors, scene);
    import_gltf_animations(*model, accessors, mapping.node, scene);
    clips_named(scene, needed_clips);

    std::size_t const mesh_count = mapping.used_meshes.size();
    scene.meshes.resize(mesh_count);
    std::vector<std::vector<std::string>> warnings(mesh_count);
    ImportBudget forecast = budget;
    for (std::size_t const mesh : mapping.used_meshes) {
        reserve_gltf_mesh(*model, accessors, mesh, forecast);
    }
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t(0), mesh_count, [&](std::size_t i) {
        scene.meshes[i] = import_gltf_mesh(*model, accessors, mapping.used_meshes[i], warnings[i]);
        std::lock_guard const lock(report);
        progress("unpacking meshes", static_cast<double>(++done) / static_cast<double>(mesh_count));
    });
    for (auto const& lines : warnings) {
        scene.warnings.insert(scene.warnings.end(), lines.begin(), lines.end());
    }

    auto const images = gltf_images(*model, accessors, folder);
    scene.images = load_images(images, folder, budget, scene.warnings, progress);
    if (!model->scenes.empty()) {
        scene.name = model->scenes[static_cast<std::size_t>(std::max(model->defaultScene, 0))].name;
    }
    return scene;
}

} // namespace framelet
