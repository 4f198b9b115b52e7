// Scenes for machines with much memory: made when they are asked for by name, and kept nowhere.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// A wood of instances: few triangles in memory, many in the picture. The camera goes round above it.
struct ForestParameters {
    double duration = 20; ///< seconds
    int trees = 86'500; ///< 1,160 triangles each
    int twigs = 520; ///< a crown
    double spacing = 4.2; ///< metres between trees
};
GltfDocument make_forest_scene(ForestParameters const& parameters);

} // namespace framelet
