#include "server/scene/summary/visibility.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

bool has_area(Primitive const& primitive, Mat4 const& world) {
    return std::any_of(primitive.triangles.begin(), primitive.triangles.end(), [&](auto const& triangle) {
        auto const corner = [&](std::size_t i) {
            return glm::dvec3(glm::dmat4(world) * glm::dvec4(glm::dvec3(primitive.positions[triangle[i]]), 1));
        };
        return glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) > 0;
    });
}

} // namespace

bool has_anything_to_see(Scene const& scene) {
    ScenePose const rest = evaluate_pose(scene, {}, 0);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        Node const& node = scene.nodes[n];
        if (node.mesh == none) {
            continue;
        }
        Mat4 const placed = scene.clips.empty() ? rest.world_from_node[n] : Mat4(1);
        for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            bool const deforms = node.skin != none || !primitive.morph_targets.empty();
            if (deforms || has_area(primitive, placed)) {
                return true;
            }
        }
    }
    return false;
}

} // namespace framelet
