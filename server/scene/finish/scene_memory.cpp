#include "server/scene/finish/scene_memory.h"

#include <algorithm>
#include <set>
#include <string>

#include "common/error.h"
#include "common/one_line.h"
#include "server/scene/finish/primitive_ops.h"

namespace framelet {
namespace {

/// Bytes of a BVH for each triangle, by measurement: of itself, and while it is built.
struct BvhBytes {
    std::uint64_t built, building;
};

constexpr BvhBytes bytes_a_triangle(BvhKind kind) {
    return kind == BvhKind::fast ? BvhBytes{68, 100} : BvhBytes{37, 42};
}

} // namespace

std::uint64_t scene_bytes(Scene const& scene) {
    std::uint64_t bytes = image_bytes(scene);
    for (Mesh const& mesh : scene.meshes) {
        for (Primitive const& primitive : mesh.primitives) {
            bytes += primitive.positions.size() * bytes_per_vertex(primitive) +
                     primitive.triangles.size() * sizeof(primitive.triangles[0]);
        }
    }
    return bytes;
}

std::uint64_t image_bytes(Scene const& scene) {
    std::uint64_t bytes = 0;
    for (auto const& image : scene.images) {
        bytes += image ? image->rgba.size() * sizeof(image->rgba[0]) : 0;
    }
    return bytes;
}

bool morphs(Mesh const& mesh) {
    return std::ranges::any_of(mesh.primitives, [](Primitive const& p) { return !p.morph_targets.empty(); });
}

bool is_deforming(Scene const& scene, Node const& node) {
    return node.skin != none || morphs(scene.meshes[static_cast<std::size_t>(node.mesh)]);
}

std::uint64_t triangles_to_build(Scene const& scene) {
    std::set<Index> shared;
    std::uint64_t count = 0;
    for (Node const& node : scene.nodes) {
        if (node.mesh != none && (is_deforming(scene, node) || shared.insert(node.mesh).second)) {
            count += count_triangles(scene.meshes[static_cast<std::size_t>(node.mesh)]);
        }
    }
    return count;
}

std::uint64_t bvh_bytes(Scene const& scene) {
    return triangles_to_build(scene) * bytes_a_triangle(scene.bvh).built;
}

BvhKind bvh_within(Scene const& scene, std::uint64_t bytes) {
    std::uint64_t const taken = scene_bytes(scene);
    std::uint64_t const left = bytes - std::min(bytes, taken);
    std::uint64_t const triangles = triangles_to_build(scene);
    if (triangles * bytes_a_triangle(BvhKind::fast).building <= std::min(left, bytes / 4)) {
        return BvhKind::fast;
    }
    std::uint64_t const least = triangles * bytes_a_triangle(BvhKind::compact).building;
    if (least > left) {
        throw InputError("cannot load scene '" + to_one_line(scene.name) + "': it takes " +
                         std::to_string((taken + least + (1 << 20) - 1) >> 20) +
                         " MB of memory with what is needed to trace it, and may take " + std::to_string(bytes >> 20) +
                         "; --scene-memory allows more");
    }
    return BvhKind::compact;
}

} // namespace framelet
