// Reads glTF 2.0 (.gltf, .glb) into a Scene that still has to be finished (scene_finish.h).
// In: a path. Out: a Scene, or an InputError without the file's name.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"
#include "server/scene/scene.h"

namespace framelet {

/// Imports the scene of that name or number, the file's default scene where `wanted_scene` is empty. Throws InputError
/// that lists the file's scenes where it is not among them. Throws before it reads meshes and pictures where the file
/// lacks a clip of a name in `needed_clips`.
Scene import_gltf(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                  std::string const& wanted_scene, std::span<std::string const> needed_clips, bool is_checked,
                  Progress const& progress);

} // namespace framelet
