#include "server/scene/finish/scene_origin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

Bounds box_of(Mesh const& mesh) {
    Bounds box;
    for (Primitive const& primitive : mesh.primitives) {
        std::for_each(primitive.positions.begin(), primitive.positions.end(),
                      [&](Vec3 const& position) { box.include(position); });
    }
    return box;
}

void move_vertices(Mesh& mesh, glm::dvec3 const& centre) {
    for (Primitive& primitive : mesh.primitives) {
        for (Vec3& position : primitive.positions) {
            position = Vec3(glm::dvec3(position) - centre);
        }
    }
}

/// A skin whose joints move vertices that lie about `centre` as `skin` moves them where they were.
Skin moved_skin(Skin skin, glm::dvec3 const& centre) {
    for (Mat4& matrix : skin.inverse_bind_matrices) {
        matrix = Mat4(glm::translate(glm::dmat4(matrix), centre));
    }
    return skin;
}

/// For each mesh the size of the scene in the mesh's own units, where its nodes show it largest.
std::vector<double> scene_size_in_meshes(Scene const& scene) {
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0);
    Vec3 const size = scene_bounds(scene, pose).size();
    std::vector<double> sizes(scene.meshes.size(), INFINITY);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        Node const& node = scene.nodes[n];
        if (node.mesh != none) {
            Mat3 const linear(pose.world_from_node[n]);
            float const scale = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
            double& of_mesh = sizes[static_cast<std::size_t>(node.mesh)];
            of_mesh = std::min<double>(of_mesh, std::max({size.x, size.y, size.z}) / (node.skin == none ? scale : 1));
        }
    }
    return sizes;
}

} // namespace

glm::dvec3 round_centre(glm::dvec3 const& lower, glm::dvec3 const& upper, double least_size) {
    constexpr double far = 8; // as often the size: three of 24 bits
    constexpr double single_precision = 0x1p-22;
    glm::dvec3 const size = upper - lower;
    glm::dvec3 const centre = 0.5 * (lower + upper);
    double const away = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
    double const largest = std::max({size.x, size.y, size.z, least_size, away * single_precision});
    if (!(away > far * largest) || !std::isfinite(away)) {
        return glm::dvec3(0);
    }
    double const step = std::exp2(std::ceil(std::log2(largest)));
    return glm::round(centre / step) * step;
}

void set_origin(Scene& scene) {
    scene.origin = glm::dvec3(0);
    for (int pass = 0; pass < 2; ++pass) { // far out, the first box is a coarse one
        Bounds const box = scene_bounds(scene, evaluate_pose(scene, default_clips(scene), 0));
        glm::dvec3 const centre = box.empty() ? glm::dvec3(0) : round_centre(box.lower, box.upper);
        if (centre == glm::dvec3(0)) {
            return;
        }
        scene.origin += centre;
    }
}

void centre_meshes(Scene& scene) {
    std::vector<glm::dvec3> centres;
    std::vector<double> const scene_size = scene_size_in_meshes(scene);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        Bounds const box = box_of(scene.meshes[m]);
        centres.push_back(box.empty() ? glm::dvec3(0) : round_centre(box.lower, box.upper, scene_size[m]));
        if (centres.back() != glm::dvec3(0)) {
            move_vertices(scene.meshes[m], centres.back());
        }
    }
    std::map<Index, Index> child_of;
    std::map<std::pair<Index, Index>, Index> skin_of; ///< by skin and mesh
    for (std::size_t n = 0, count = scene.nodes.size(); n < count; ++n) {
        Index const mesh = scene.nodes[n].mesh;
        if (mesh == none || centres[static_cast<std::size_t>(mesh)] == glm::dvec3(0)) {
            continue;
        }
        glm::dvec3 const& centre = centres[static_cast<std::size_t>(mesh)];
        Node child = scene.nodes[n];
        child.parent = static_cast<Index>(n);
        child.local = {centre, Quat(1, 0, 0, 0), Vec3(1)};
        child.matrix.reset();
        if (child.skin != none) {
            auto const [found, added] = skin_of.try_emplace({child.skin, mesh}, static_cast<Index>(scene.skins.size()));
            if (added) {
                scene.skins.push_back(moved_skin(scene.skins[static_cast<std::size_t>(child.skin)], centre));
            }
            child.skin = found->second;
        }
        child_of[static_cast<Index>(n)] = static_cast<Index>(scene.nodes.size());
        scene.nodes[n].mesh = scene.nodes[n].skin = none;
        scene.nodes[n].morph_weights.clear();
        scene.nodes.push_back(std::move(child));
    }
    for (AnimationClip& clip : scene.clips) {
        for (AnimationChannel& channel : clip.channels) {
            auto const found = child_of.find(channel.node);
            if (channel.property == AnimatedProperty::morph_weights && found != child_of.end()) {
                channel.node = found->second;
            }
        }
    }
}

} // namespace framelet
