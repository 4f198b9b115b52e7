// Reads scene files. In: their paths. Out: a Scene value. glTF is read here (exact to the specification: sparse
// accessors, step and spline keys, samplers, extensions), everything else through Assimp.
#pragma once

#include <filesystem>
#include <span>

#include "server/scene/reading/import_options.h"
#include "server/scene/reading/progress.h"
#include "server/scene/scene.h"

namespace framelet {

/// Reads and finishes a scene. Throws InputError with one line that names the file where it cannot be loaded. The scene
/// it returns is consistent: every index is in range, every attribute has the right length, every number is finite,
/// skin weights sum to 1.
Scene import_scene(std::filesystem::path const& file, Progress const& progress = {}, ImportOptions const& options = {});

/// Reads several scene files into one scene, each where it has its things (see `merged_scene`). All of them together
/// have the memory, each reads from its own folder. `progress` is told of each file by its name.
Scene import_scenes(std::span<std::filesystem::path const> files, Progress const& progress = {},
                    ImportOptions const& options = {});

} // namespace framelet
