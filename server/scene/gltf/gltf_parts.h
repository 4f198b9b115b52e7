// The parts of the glTF importer. Each turns one kind of thing of a file into scene values.
// In: the file, checked reading of its accessors. Out: parts of a Scene. Where the file is wrong, what is concerned is
// left out, with a line in `faults` that names it.
#pragma once

#include <string>
#include <vector>

#include "server/scene/gltf/gltf_json.h"
#include "server/scene/scene.h"

namespace framelet {

class GltfAccessors;
class ImportBudget;

/// Imports textures and materials; image and texture indices are the file's.
void import_gltf_materials(Json const& json, Scene& scene, std::vector<std::string>& faults);

/// What comes of one mesh of the file.
struct GltfMesh {
    Mesh mesh; ///< material indices are the file's, `none` where a primitive has no material
    std::vector<std::string> remarks, faults;
};

/// Imports mesh `index` of the file.
GltfMesh import_gltf_mesh(Json const& json, GltfAccessors const& accessors, std::size_t index);

/// Reserves what `import_gltf_mesh` and flat shading make of mesh `index`, so that a file that asks for too much is
/// refused before the first of it is made.
void reserve_gltf_mesh(Json const& json, GltfAccessors const& accessors, std::size_t index, ImportBudget& budget);

/// What of the file is where in the scene.
struct GltfMapping {
    std::vector<Index> node; ///< the scene's index of each of the file's nodes; `none` where the scene does not use it
    std::vector<std::size_t> used_meshes; ///< the file's indices, in the scene's order
};

/// Imports the nodes of the file's scene `chosen` (of all its nodes where it has no scenes), parents first, with their
/// cameras, lights and skins. Reserves instances (EXT_mesh_gpu_instancing) in the budget. Throws InputError where they
/// form no tree: a node is below itself, or has two parents.
GltfMapping import_gltf_nodes(Json const& json, std::size_t chosen, GltfAccessors const& accessors,
                              ImportBudget& budget, Scene& scene, std::vector<std::string>& faults);

/// Imports the animations of nodes that are in the scene.
void import_gltf_animations(Json const& json, GltfAccessors const& accessors, std::vector<Index> const& node_of,
                            Scene& scene, std::vector<std::string>& faults);

} // namespace framelet
