#include "server/scene/finish/primitive_finish.h"

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/finish/normals.h"
#include "server/scene/finish/primitive_ops.h"
#include "server/scene/finish/tangents.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

void check_structure(Primitive const& primitive) {
    std::size_t const count = primitive.positions.size();
    auto const fits = [&](auto const& attribute) { return attribute.empty() || attribute.size() == count; };
    bool ok = fits(primitive.normals) && fits(primitive.tangents) && fits(primitive.uv[0]) && fits(primitive.uv[1]) &&
              fits(primitive.colors) && fits(primitive.influences);
    for (MorphTarget const& target : primitive.morph_targets) {
        ok = ok && fits(target.positions) && fits(target.normals) && fits(target.tangents);
    }
    for (auto const& triangle : primitive.triangles) {
        ok = ok && triangle[0] < count && triangle[1] < count && triangle[2] < count;
    }
    if (!ok) {
        throw InputError("its vertex attributes or indices do not fit together");
    }
}

void check_positions(std::vector<Vec3> const& positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!in_range(positions[i])) {
            throw InputError("the position of vertex " + std::to_string(i) +
                             (is_finite(positions[i]) ? " is out of range" : " is not a number"));
        }
    }
}

/// Replaces vectors with components that are no number, or absurd; returns how many.
template <class T>
std::size_t repair(std::vector<T>& values, T const& otherwise) {
    std::size_t count = 0;
    for (T& value : values) {
        for (int c = 0; c < T::length(); ++c) {
            if (!in_range(value[c])) {
                value = otherwise;
                ++count;
                break;
            }
        }
    }
    return count;
}

/// Makes weights sum to 1, the strongest first; a vertex without any belongs to its first joint.
void normalise_influences(Primitive& primitive) {
    for (JointInfluence& influence : primitive.influences) {
        std::array<std::pair<float, std::uint16_t>, 4> sorted;
        float sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            float const weight = influence.weights[k];
            sorted[k] = {weight > 0 ? std::min(weight, max_coordinate) : 0, influence.joints[k]};
            sum += sorted[k].first;
        }
        std::stable_sort(sorted.begin(), sorted.end(), [](auto const& x, auto const& y) { return x.first > y.first; });
        for (std::size_t k = 0; k < 4; ++k) {
            influence.weights[k] = sum > 0 ? sorted[k].first / sum : (k == 0 ? 1.0f : 0.0f);
            influence.joints[k] = sorted[k].second;
        }
    }
}

void complete_tangents(Primitive& primitive, Material const& material) {
    TextureUse const& use = material.normal_texture;
    if (use.texture == none) {
        primitive.tangents.clear();
        for (MorphTarget& target : primitive.morph_targets) {
            target.tangents.clear();
        }
    } else if (!primitive.tangents.empty()) {
        repair_tangents(primitive);
    } else {
        std::vector<Vec2> uv = primitive.uv[static_cast<std::size_t>(use.uv_set)];
        for (Vec2& coordinate : uv) {
            coordinate = transform_uv(use, coordinate);
        }
        make_tangents(primitive, uv);
    }
}

/// Texture coordinates that the material's textures ask for but the file does not have are 0.
void complete_uv(Primitive& primitive, Material const& material) {
    for (TextureUse const* const use : texture_uses(material)) {
        if (use->texture != none) {
            primitive.uv[static_cast<std::size_t>(use->uv_set)].resize(primitive.positions.size());
        }
    }
}

} // namespace

PrimitiveRepairs finish_primitive(Primitive& primitive, Material const& material) {
    check_structure(primitive);
    drop_unused_vertices(primitive);
    check_positions(primitive.positions);
    PrimitiveRepairs repairs;
    repairs.other =
        repair(primitive.uv[0], Vec2(0)) + repair(primitive.uv[1], Vec2(0)) + repair(primitive.colors, Vec4(1));
    for (MorphTarget& target : primitive.morph_targets) {
        repairs.other +=
            repair(target.positions, Vec3(0)) + repair(target.normals, Vec3(0)) + repair(target.tangents, Vec3(0));
    }
    normalise_influences(primitive);
    if (primitive.normals.empty()) {
        make_flat_normals(primitive);
    } else {
        repairs.normals = repair_normals(primitive);
    }
    complete_uv(primitive, material);
    complete_tangents(primitive, material);
    primitive.positions.reserve(primitive.positions.size() + 1); // a BVH may then read them where they are
    return repairs;
}

} // namespace framelet
