// Mends what Assimp reads and does not look at: between its importers and its last steps. In and out: an aiScene and
// its meshes.
#pragma once

#include <vector>

#include <assimp/vector3.h>

struct aiMesh;
struct aiScene;

namespace framelet {

/// Makes a mesh without normals of one that lacks some or all: no length, or no numbers. Each corner of its
/// polygons then has a vertex of its own: where vertices are shared, Assimp smooths across every edge. Returns what the
/// normals were, one a vertex; empty where the file has none, or all of them.
std::vector<aiVector3D> take_normals(aiMesh& mesh);

/// Puts those of the normals taken that can be used in place of the mesh's new ones.
void put_back_normals(aiMesh& mesh, std::vector<aiVector3D> const& taken);

/// Turns and scales the scene as the GlobalSettings of an FBX file say: y is up, a unit is a metre. Leaves other
/// scenes alone.
void place_by_settings(aiScene const& scene);

} // namespace framelet
