// The content of a glTF 2.0 file as values: the scenes fill a GltfDocument, gltf_writer puts it into a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/mesh/geometry.h"

namespace framelet {

inline constexpr int no_index = -1;

struct GltfMaterial {
    std::string name;
    D3 base_color{1, 1, 1}; ///< linear
    double metallic = 0;
    double roughness = 1;
    D3 emissive{0, 0, 0}; ///< above 1 by KHR_materials_emissive_strength
    int base_color_texture = no_index; ///< index of an image
    double alpha_cutoff = 0; ///< above 0: alpha mask
    bool double_sided = false;
    bool unlit = false; ///< KHR_materials_unlit
    double transmission = 0; ///< share of what is not reflected that goes straight through, KHR_materials_transmission

    bool operator==(GltfMaterial const&) const = default;
};

/// What is added to positions and normals, times the target's weight; one entry a vertex each.
struct GltfMorphTarget {
    std::vector<D3> positions, normals;
};

/// A mesh has one primitive a material; all of them have equally many morph targets.
struct GltfPrimitive {
    MeshData data;
    int material = 0;
    std::vector<GltfMorphTarget> targets{};
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
};

struct GltfNode {
    std::string name;
    Placement place{};
    int mesh = no_index;
    int camera = no_index;
    int light = no_index;
    int skin = no_index; ///< moves `mesh`, whose vertices have joints; the node's own place then counts for nothing
    std::vector<int> children{};
};

/// Joints as the mesh was made for them: not turned, at these places in its space.
struct GltfSkin {
    std::vector<int> joints; ///< nodes
    std::vector<D3> places; ///< one a joint
};

struct GltfCamera {
    std::string name;
    double vertical_fov = 0.7; ///< radians
};

/// A light as in KHR_lights_punctual; it shines along its node's -Z.
struct GltfLight {
    std::string type; ///< "directional", "point"
    D3 color{1, 1, 1}; ///< linear
    double intensity = 1; ///< candela for point, lux for directional
};

enum class GltfPath : std::uint8_t { translation, rotation, weights };

/// Keys of one property of one or more nodes (which then share the keys). Rotations are x, y, z, w; weights are those
/// of the mesh's morph targets, four at most.
struct GltfTrack {
    std::vector<int> nodes;
    GltfPath path = GltfPath::translation;
    bool step = false; ///< holds each value until the next key; else linear
    std::vector<double> times; ///< seconds, increasing
    std::vector<D4> values; ///< translations leave w alone
};

struct GltfDocument {
    std::string name;
    /// How it wants to be lit, as --light says it, in the asset's extras; empty: as the server finds best. Most scenes
    /// were made for this light, and what is measured with them stays comparable.
    std::string light = "direct";
    std::vector<std::string> images; ///< PNG files
    std::vector<GltfMaterial> materials;
    std::vector<GltfMesh> meshes;
    std::vector<GltfNode> nodes;
    std::vector<GltfSkin> skins;
    std::vector<GltfCamera> cameras;
    std::vector<GltfLight> lights;
    std::vector<GltfTrack> tracks; ///< one clip

    /// These return an index; an image or a material that is already there is not added again.
    int add_image(std::string png);
    int add_material(GltfMaterial material);
    int add_mesh(std::string name, std::vector<GltfPrimitive> primitives);
    /// Adds a mesh of one material and a node that shows it; returns the node.
    int add_object(std::string name, MeshData data, int material, Placement const& place = {}, int parent = no_index);
    /// Adds the node, to `parent` where one is given.
    int add_node(GltfNode node, int parent = no_index);
};

/// Triangles drawn: those of a mesh count once for each node that shows it.
std::size_t drawn_triangles(GltfDocument const& document);

} // namespace framelet
