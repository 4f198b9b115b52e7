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
        std::size_t targets = 0;
        for (Primitive const& primitive : mesh.primitives) {
            targets = std::max(targets, primitive.morph_targets.size());
        }
        for (Primitive& primitive : mesh.primitives) {
            if (primitive.morph_targets.size() != targets) {
                scene.warnings.push_back(named("mesh", i, mesh.name) +
                                         ": its primitives have different morph targets; those without stand still");
                primitive.morph_targets.resize(targets);
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
            scene.warnings.push_back(named("node", i, node.name) +
                                     " has a transform that is not a number or out of range; it is passed over");
            local = {};
            node.matrix.reset();
        }
        local.rotation = unit_rotation(local.rotation);
    }
}

bool is_usable(Mat4 const& matrix) {
    bool ok = true;
    for (int c = 0; c < 4; ++c) {
        ok = ok && glm::length(matrix[c]) <= max_coordinate;
    }
    return ok;
}

/// The first joint that an influence names and a skin of `joints` lacks; -1 where there is none.
int lacking_joint(Mesh const& mesh, std::size_t joints) {
    for (Primitive const& primitive : mesh.primitives) {
        for (JointInfluence const& influence : primitive.influences) {
            for (std::uint16_t const joint : influence.joints) {
                if (joint >= joints) {
                    return joint;
                }
            }
        }
    }
    return -1;
}

/// Takes skins off that have joints outside the scene or matrices that are no numbers, and off meshes that have no
/// influences, or some that name a joint which their skin lacks.
void finish_skins(Scene& scene) {
    for (std::size_t i = 0; i < scene.skins.size(); ++i) {
        Skin& skin = scene.skins[i];
        FRAMELET_CHECK(skin.joints.size() == skin.inverse_bind_matrices.size());
        if (std::ranges::find(skin.joints, none) != skin.joints.end()) {
            scene.warnings.push_back(named("skin", i, "") + " has joints outside the scene; shown without it");
            skin = {};
        }
        if (!std::ranges::all_of(skin.inverse_bind_matrices, is_usable)) {
            scene.warnings.push_back(named("skin", i, "") +
                                     " has an inverse bind matrix that is not a number; shown without it");
            skin = {};
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
        if (int const joint = lacking_joint(mesh, joints); joint >= 0) {
            scene.warnings.push_back(named("mesh", static_cast<std::size_t>(node.mesh), mesh.name) + " uses joint " +
                                     std::to_string(joint) + " of a skin with " + std::to_string(joints) +
                                     "; shown without it");
            node.skin = none;
            continue;
        }
        for (Primitive& primitive : mesh.primitives) {
            if (primitive.influences.empty()) { // scene.h promises influences where a node has a skin
                primitive.influences.assign(primitive.positions.size(), JointInfluence{{}, {1, 0, 0, 0}});
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
