// The parts of the glTF importer. Each turns one kind of thing of a tinygltf model into scene values.
// In: the model, checked reading of its accessors. Out: parts of a Scene; InputError where the file is wrong.
#pragma once

#include <string>
#include <vector>

#include "server/scene/scene.h"

namespace tinygltf {
class Model;
}

namespace framelet {

class GltfAccessors;
class ImportBudget;

/// Imports textures and materials; image and texture indices are the file's.
void import_gltf_materials(tinygltf::Model const& model, Scene& scene);

/// Imports mesh `index` of the file. Material indices are the file's, `none` where a primitive has no material.
Mesh import_gltf_mesh(tinygltf::Model const& model, GltfAccessors const& accessors, std::size_t index,
                      std::vector<std::string>& warnings);

/// Reserves what `import_gltf_mesh` and flat shading make of mesh `index`, so that a file that asks for too much is
/// refused before the first of it is made.
void reserve_gltf_mesh(tinygltf::Model const& model, GltfAccessors const& accessors, std::size_t index,
                       ImportBudget& budget);

/// What of the file is where in the scene.
struct GltfMapping {
    std::vector<Index> node; ///< the scene's index of each of the file's nodes; `none` where the scene does not use it
    std::vector<std::size_t> used_meshes; ///< the file's indices, in the scene's order
};

/// Imports the nodes of the default scene, parents first, with their cameras, lights and skins. A node that is reached
/// twice (a cycle, or two parents) is an InputError.
GltfMapping import_gltf_nodes(tinygltf::Model const& model, GltfAccessors const& accessors, Scene& scene);

/// Imports the animations of nodes that are in the scene.
void import_gltf_animations(tinygltf::Model const& model, GltfAccessors const& accessors,
                            std::vector<Index> const& node_of, Scene& scene);

} // namespace framelet
