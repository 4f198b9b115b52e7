#include "scenes/gltf/gltf_document.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {

namespace {

template <typename Value>
int find_or_add(std::vector<Value>& values, Value value) {
    auto const found = std::find(values.begin(), values.end(), value);
    if (found != values.end()) {
        return static_cast<int>(found - values.begin());
    }
    values.push_back(std::move(value));
    return static_cast<int>(values.size()) - 1;
}

} // namespace

int GltfDocument::add_image(std::string png) {
    return find_or_add(images, std::move(png));
}

int GltfDocument::add_material(GltfMaterial material) {
    return find_or_add(materials, std::move(material));
}

int GltfDocument::add_object(std::string object_name, MeshData data, int material, Placement const& place, int parent) {
    int const mesh = add_mesh(object_name, {{std::move(data), material}});
    return add_node({.name = std::move(object_name), .place = place, .mesh = mesh}, parent);
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
