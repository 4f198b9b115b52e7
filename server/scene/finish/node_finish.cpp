#include <algorithm>

#include "common/error.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

/// Gives every morph target a weight: missing ones are 0, those too many are dropped.
void finish_morph_weights(Scene& scene) {
    auto const repair = [](std::vector<float>& weights, std::size_t targets) {
        weights.resize(targets);
        for (float& weight : weights) {
            weight = clamped(weight, -max_coordinate, max_coordinate, 0);
        }
    };
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        Mesh& mesh = scene.meshes[i];
        std::size_t const targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().morph_targets.size();
        for (Primitive const& primitive : mesh.primitives) {
            if (primitive.morph_targets.size() != targets) {
                throw InputError(named("mesh", i, mesh.name) + ": its primitives have different morph targets");
            }
        }
        repair(mesh.morph_weights, targets);
    }
    for (Node& node : scene.nodes) {
        if (node.mesh == none) {
            node.morph_weights.clear();
        } else if (!node.morph_weights.empty()) {
            repair(node.morph_weights, scene.meshes[static_cast<std::size_t>(node.mesh)].morph_weights.size());
        }
    }
}

void finish_transforms(Scene& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        FRAMELET_CHECK(node.parent >= none && node.parent < static_cast<Index>(i));
        FRAMELET_CHECK(node.mesh >= none && node.mesh < static_cast<Index>(scene.meshes.size()));
        Transform& local = node.local;
        Quat const& q = local.rotation;
        bool ok = in_range(q.x) && in_range(q.y) && in_range(q.z) && in_range(q.w) && in_range(local.translation) &&
                  in_range(local.scale);
        if (node.matrix) {
            for (int column = 0; column < 4; ++column) {
                glm::dvec4& v = (*node.matrix)[column];
                v.w = column == 3 ? 1 : 0;
                ok = ok && in_range(Vec3(v));
            }
        }
        if (!ok) {
            throw InputError(named("node", i, node.name) + " has a transform that is not a number or out of range");
        }
        local.rotation = unit_rotation(local.rotation);
    }
}

/// Takes skins off that have joints outside the scene, or whose mesh has no influences. Throws InputError where an
/// influence names a joint that its skin lacks, or an inverse bind matrix is not a number.
void finish_skins(Scene& scene) {
    for (std::size_t i = 0; i < scene.skins.size(); ++i) {
        Skin& skin = scene.skins[i];
        FRAMELET_CHECK(skin.joints.size() == skin.inverse_bind_matrices.size());
        if (std::ranges::find(skin.joints, none) != skin.joints.end()) {
            scene.warnings.push_back(named("skin", i, "") + " has joints outside the scene; shown without it");
            skin = {};
        }
        for (Mat4 const& matrix : skin.inverse_bind_matrices) {
            for (int c = 0; c < 4; ++c) {
                if (!(glm::length(matrix[c]) <= max_coordinate)) {
                    throw InputError(named("skin", i, "") + " has an inverse bind matrix that is not a number");
                }
            }
        }
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        if (node.skin == none || node.mesh == none) {
            node.skin = none;
            continue;
        }
        std::size_t const joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        bool const any = std::ranges::any_of(mesh.primitives, [](Primitive const& p) { return !p.influences.empty(); });
        if (joints == 0 || !any) {
            node.skin = none;
            continue;
        }
        for (Primitive& primitive : mesh.primitives) {
            if (primitive.influences.empty()) { // scene.h promises influences where a node has a skin
                primitive.influences.assign(primitive.positions.size(), JointInfluence{{}, {1, 0, 0, 0}});
            }
            for (JointInfluence const& influence : primitive.influences) {
                for (std::uint16_t const joint : influence.joints) {
                    if (joint >= joints) {
                        throw InputError(named("mesh", static_cast<std::size_t>(node.mesh), mesh.name) +
                                         " uses joint " + std::to_string(joint) + " of a skin with " +
                                         std::to_string(joints));
                    }
                }
            }
        }
    }
}

} // namespace

void finish_nodes(Scene& scene) {
    finish_morph_weights(scene);
    finish_transforms(scene);
    finish_skins(scene);
}

} // namespace framelet
