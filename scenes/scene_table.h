// The one list of all scenes: name, length, and the parameters it is made from.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenes/gltf/gltf_document.h"

namespace framelet {

struct SceneEntry {
    std::string name; ///< the file is NAME.glb
    double duration; ///< seconds, of the animation's loop
    bool committed; ///< false: too large for the repository, made while building
    std::function<GltfDocument()> make;
};

std::span<SceneEntry const> scene_table();
/// Those that are made only where they are asked for by name: large ones.
std::span<SceneEntry const> large_scene_table();

} // namespace framelet
