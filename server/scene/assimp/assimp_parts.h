// The parts of the Assimp importer. Each turns one kind of thing of an aiScene into scene values.
// In: a complete aiScene, triangulated. Out: parts of a Scene.
#pragma once

#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/progress.h"
#include "server/scene/reading/scene_folder.h"
#include "server/scene/scene.h"

struct aiMesh;
struct aiScene;

namespace framelet {

/// Imports images, textures and materials, decoded.
void import_assimp_materials(aiScene const& from, SceneFolder const& folder, ImportBudget& budget, Scene& scene,
                             Progress const& progress);

/// Imports a mesh's triangles; its points, lines and bones are left out.
Primitive import_assimp_primitive(aiMesh const& from);

/// Imports nodes with their meshes, skins, cameras, lights and animations. Nodes that list the same parts share a mesh,
/// another list copies its parts: copies are reserved before they are made.
void import_assimp_nodes(aiScene const& from, ImportBudget& budget, Scene& scene);

} // namespace framelet
