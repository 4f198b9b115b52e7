// Morphing and skinning (glTF 2.0 sections 3.7.2.2 and 3.7.3.3): morph targets first, then linear blend skinning.
#include <algorithm>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/scene/motion/animation.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

/// Number of vertices that one task takes; small enough to spread, large enough to be worth it.
constexpr std::size_t grain = 2048;

/// Calls `add(TARGET, WEIGHT)` for each target that counts. `weights` has one entry a target.
template <class Add>
void for_each_target(Primitive const& primitive, std::span<float const> weights, Add add) {
    for (std::size_t t = 0; t < std::min(weights.size(), primitive.morph_targets.size()); ++t) {
        if (weights[t] != 0) {
            add(primitive.morph_targets[t], weights[t]);
        }
    }
}

/// Sets positions [first, last) to the morphed ones.
void morph_positions(Primitive const& primitive, std::span<float const> weights, std::size_t first, std::size_t last,
                     std::span<Vec3> out) {
    std::copy_n(primitive.positions.data() + first, last - first, out.data() + first);
    for_each_target(primitive, weights, [&](MorphTarget const& target, float weight) {
        for (std::size_t i = first; i < last && !target.positions.empty(); ++i) {
            out[i] += weight * target.positions[i];
        }
    });
}

/// Adds the weighted targets to normals and tangents of vertices [first, last).
void morph_frames(Primitive const& primitive, std::span<float const> weights, std::size_t first, std::size_t last,
                  DeformedVertices& out) {
    bool normals_changed = false;
    for_each_target(primitive, weights, [&](MorphTarget const& target, float weight) {
        if (!target.normals.empty()) {
            normals_changed = true;
            for (std::size_t i = first; i < last; ++i) {
                out.normals[i] += weight * target.normals[i];
            }
        }
        if (!target.tangents.empty() && !out.tangents.empty()) {
            for (std::size_t i = first; i < last; ++i) {
                out.tangents[i] += weight * Vec4(target.tangents[i], 0);
            }
        }
    });
    if (normals_changed) {
        for (std::size_t i = first; i < last; ++i) {
            out.normals[i] = unit_or(out.normals[i], primitive.normals[i]);
        }
    }
}

/// Normals follow the inverse transpose; the cofactors are that times the determinant, without a division.
Vec3 transform_normal(Mat4 const& m, Vec3 const& n, float determinant_sign) {
    Vec3 const x(m[0]);
    Vec3 const y(m[1]);
    Vec3 const z(m[2]);
    Vec3 const result = n.x * glm::cross(y, z) + n.y * glm::cross(z, x) + n.z * glm::cross(x, y);
    return unit_or(result * determinant_sign, n);
}

/// Sets `joints` to what each joint does to vertices.
void find_joints(Skin const& skin, ScenePose const& pose, std::vector<Mat4>& joints) {
    joints.clear();
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        joints.push_back(pose.world_from_node[static_cast<std::size_t>(skin.joints[j])] *
                         skin.inverse_bind_matrices[j]);
    }
}

Mat4 blended(JointInfluence const& influence, std::span<Mat4 const> joints) {
    Mat4 blend = influence.weights[0] * joints[influence.joints[0]];
    for (std::size_t k = 1; k < 4 && influence.weights[k] > 0; ++k) { // the strongest come first
        blend += influence.weights[k] * joints[influence.joints[k]];
    }
    return blend;
}

void skin_vertices(Primitive const& primitive, std::span<Mat4 const> joints, std::size_t first, std::size_t last,
                   DeformedVertices& out) {
    for (std::size_t i = first; i < last; ++i) {
        Mat4 const blend = blended(primitive.influences[i], joints);
        out.positions[i] = Vec3(blend * Vec4(out.positions[i], 1));
        float const determinant = glm::dot(glm::cross(Vec3(blend[0]), Vec3(blend[1])), Vec3(blend[2]));
        float const sign = determinant < 0 ? -1.0f : 1.0f;
        out.normals[i] = transform_normal(blend, out.normals[i], sign);
        if (!out.tangents.empty()) {
            Vec4 const t = out.tangents[i];
            out.tangents[i] = Vec4(Mat3(blend) * Vec3(t), t.w * sign);
        }
    }
}

/// Makes morphed or skinned tangents unit length and puts them into the tangent plane again.
void square_tangents(std::size_t first, std::size_t last, DeformedVertices& out) {
    for (std::size_t i = first; i < last && !out.tangents.empty(); ++i) {
        Vec3 const n = out.normals[i];
        Vec3 const t(out.tangents[i]);
        out.tangents[i] = Vec4(unit_or(t - n * glm::dot(n, t), any_perpendicular(n)), out.tangents[i].w);
    }
}

} // namespace

void deform(Primitive const& primitive, std::span<float const> morph_weights, Skin const* skin, ScenePose const& pose,
            DeformedVertices& out) {
    std::size_t const count = primitive.positions.size();
    out.positions.resize(count);
    out.normals.resize(count);
    out.tangents.resize(primitive.tangents.size());
    if (skin) {
        FRAMELET_CHECK(primitive.influences.size() == count);
        find_joints(*skin, pose, out.joint_matrices);
    }
    tbb::parallel_for(std::size_t(0), (count + grain - 1) / grain, [&](std::size_t block) {
        std::size_t const first = block * grain;
        std::size_t const last = std::min(first + grain, count);
        auto const copy = [&](auto const& from, auto& to) {
            if (!from.empty()) {
                std::copy_n(from.data() + first, last - first, to.data() + first);
            }
        };
        copy(primitive.normals, out.normals);
        copy(primitive.tangents, out.tangents);
        morph_positions(primitive, morph_weights, first, last, out.positions);
        morph_frames(primitive, morph_weights, first, last, out);
        if (skin) {
            skin_vertices(primitive, out.joint_matrices, first, last, out);
        }
        square_tangents(first, last, out);
    });
}

void deform_positions(Primitive const& primitive, std::span<float const> morph_weights, Skin const* skin,
                      ScenePose const& pose, Mat3 const& linear, Vec3 const& translation, std::span<Vec3> out) {
    FRAMELET_CHECK(out.size() == primitive.positions.size() &&
                   (!skin || primitive.influences.size() == primitive.positions.size()));
    std::vector<Mat4> joints;
    if (skin) {
        find_joints(*skin, pose, joints);
    }
    tbb::parallel_for(std::size_t(0), (out.size() + grain - 1) / grain, [&](std::size_t block) {
        std::size_t const first = block * grain;
        std::size_t const last = std::min(first + grain, out.size());
        morph_positions(primitive, morph_weights, first, last, out);
        for (std::size_t i = first; i < last; ++i) {
            Vec3 const own = skin ? Vec3(blended(primitive.influences[i], joints) * Vec4(out[i], 1)) : out[i];
            out[i] = linear * own + translation;
        }
    });
}

} // namespace framelet
