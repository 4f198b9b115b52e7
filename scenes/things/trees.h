// Parts of plants, rooted at the origin. Leaves are cards with the texture coordinates of `leaf_texture` and colours.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

struct PlantMaterials {
    int leaves, bark;
};
PlantMaterials add_plant_materials(GltfDocument& document);

/// `twigs` on shells about (0, 4, 0), 4 m across; lit as the crown is, not each by its own plane.
MeshData make_crown(std::uint32_t seed, int twigs);
/// 5 m high, with branches, without texture coordinates.
MeshData make_trunk();
/// A few cards from one root.
MeshData make_fern();

} // namespace framelet
