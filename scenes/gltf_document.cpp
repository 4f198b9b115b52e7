#include "scenes/gltf_document.h"

#include "common/error.h"

namespace framelet {

int GltfDocument::add_material(GltfMaterial material) {
    materials.push_back(std::move(material));
    return static_cast<int>(materials.size()) - 1;
}

int GltfDocument::add_mesh(std::string mesh_name, std::vector<GltfPrimitive> primitives) {
    meshes.push_back({std::move(mesh_name), std::move(primitives)});
    return static_cast<int>(meshes.size()) - 1;
}

int GltfDocument::add_node(GltfNode node, int parent) {
    int const index = static_cast<int>(nodes.size());
    FRAMELET_CHECK(parent < index);
    nodes.push_back(std::move(node));
    if (parent != no_index) {
        nodes[static_cast<std::size_t>(parent)].children.push_back(index);
    }
    return index;
}

std::size_t drawn_triangles(GltfDocument const& document) {
    std::size_t count = 0;
    for (GltfNode const& node : document.nodes) {
        if (node.mesh != no_index) {
            for (GltfPrimitive const& primitive : document.meshes.at(static_cast<std::size_t>(node.mesh)).primitives) {
                count += primitive.data.indices.size() / 3;
            }
        }
    }
    return count;
}

} // namespace framelet
