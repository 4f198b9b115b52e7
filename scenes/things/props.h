// Things that stand about: trees, houses, posts. Each function adds a mesh and returns its index; all stand on y = 0.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// A conifer of stacked, ragged cones, 1 m tall: scale it. `seed` varies the raggedness.
int add_conifer_mesh(GltfDocument& document, std::uint32_t seed);
/// A round-headed tree, 1 m tall: scale it.
int add_broadleaf_mesh(GltfDocument& document, std::uint32_t seed);
/// A house with `bays` windows along X, `depth_bays` along Z, `floors`, each bay 3 m, with a pitched roof.
int add_house_mesh(GltfDocument& document, int bays, int depth_bays, int floors);
/// A wooden mast with a crossbar and insulators, 8 m: thin against the sky.
int add_mast_mesh(GltfDocument& document);
/// A fence of upright pales along X, `length` metres, 1.2 m high.
int add_fence_mesh(GltfDocument& document, double length);

} // namespace framelet
