// A scene file in, a Scene value out. glTF goes through tinygltf (exact to the specification: sparse accessors, step
// and spline keys, samplers, extensions), everything else through Assimp.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "server/scene/scene.h"

namespace framelet {

/// Told what is being done and how much of it, 0..1. Calls may come from any thread, one at a time.
using Progress = std::function<void(std::string_view what, double fraction)>;

/// Throws InputError with one line that names the file where it cannot be loaded. The scene it returns is consistent:
/// every index is in range, every attribute has the right length, every number is finite, skin weights sum to 1.
Scene import_scene(std::filesystem::path const& file, Progress const& progress = {});

} // namespace framelet
