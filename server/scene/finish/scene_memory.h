// How much memory a scene takes, and what kind of BVH fits into what it may take. In: a finished scene. Out: bytes.
#pragma once

#include <cstdint>

#include "server/scene/scene.h"

namespace framelet {

/// Bytes of triangles, their attributes and pictures.
std::uint64_t scene_bytes(Scene const& scene);

/// Bytes of the pictures alone.
std::uint64_t image_bytes(Scene const& scene);

/// Bytes of what is kept for each node: its place, its instance in the BVH, the poses about it.
inline constexpr std::uint64_t bytes_a_node = 2700; // measured

/// Number of triangles that BVHs are built over: those of a mesh once, and once more for each node that deforms it.
std::uint64_t triangles_to_build(Scene const& scene);

/// Whether the mesh has morph targets.
bool morphs(Mesh const& mesh);

/// Whether the node has vertices of its own, which its clips or its skin move.
bool is_deforming(Scene const& scene, Node const& node);

/// Bytes of the scene's BVH, once it is built.
std::uint64_t bvh_bytes(Scene const& scene);

/// Says how the scene's BVH is to be built where all of the scene may take so many bytes: as a fast one where that
/// takes no more than a quarter of them, for a compact one is also built in half the time. Throws InputError where not
/// even that has room.
BvhKind bvh_within(Scene const& scene, std::uint64_t bytes);

} // namespace framelet
