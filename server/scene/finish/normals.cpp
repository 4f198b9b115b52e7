#include "server/scene/finish/normals.h"

#include "server/scene/finish/primitive_ops.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

Vec3 face_normal(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec3 const& otherwise) {
    return unit_or(glm::cross(unit_or(b - a, Vec3(0)), unit_or(c - a, Vec3(0))), otherwise);
}

/// Flat normals of an unshared triangle list, `offsets` added to the positions where not empty.
std::vector<Vec3> flat_normals(std::vector<Vec3> const& positions, std::vector<Vec3> const& offsets) {
    std::vector<Vec3> normals(positions.size());
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        std::array<Vec3, 3> p{positions[i], positions[i + 1], positions[i + 2]};
        for (std::size_t k = 0; k < 3 && !offsets.empty(); ++k) {
            p[k] += offsets[i + k];
        }
        normals[i] = normals[i + 1] = normals[i + 2] = face_normal(p[0], p[1], p[2], Vec3(0, 1, 0));
    }
    return normals;
}

} // namespace

void make_flat_normals(Primitive& primitive) {
    std::vector<std::uint32_t> corners;
    corners.reserve(primitive.triangles.size() * 3);
    for (auto const& triangle : primitive.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    std::size_t const triangle_count = primitive.triangles.size();
    primitive.normals.clear();
    primitive.tangents.clear();
    primitive = gather_vertices(primitive, corners);
    primitive.triangles.resize(triangle_count);
    for (std::size_t i = 0; i < triangle_count; ++i) {
        auto const first = static_cast<std::uint32_t>(i * 3);
        primitive.triangles[i] = {first, first + 1, first + 2};
    }
    primitive.normals = flat_normals(primitive.positions, {});
    for (MorphTarget& target : primitive.morph_targets) {
        target.tangents.clear();
        target.normals.clear();
        if (!target.positions.empty()) {
            target.normals = flat_normals(primitive.positions, target.positions);
            for (std::size_t i = 0; i < target.normals.size(); ++i) {
                target.normals[i] -= primitive.normals[i];
            }
        }
    }
}

std::size_t repair_normals(Primitive& primitive) {
    std::vector<bool> broken(primitive.normals.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
        Vec3& normal = primitive.normals[i];
        Vec3 const unit = is_finite(normal) ? unit_or(normal, Vec3(0)) : Vec3(0);
        broken[i] = unit == Vec3(0);
        count += broken[i];
        normal = unit;
    }
    if (count == 0) {
        return 0;
    }
    for (auto const& t : primitive.triangles) {
        std::array<Vec3, 3> const p{primitive.positions[t[0]], primitive.positions[t[1]], primitive.positions[t[2]]};
        Vec3 const face = face_normal(p[0], p[1], p[2], Vec3(0));
        for (std::size_t k = 0; k < 3; ++k) {
            if (broken[t[k]]) {
                primitive.normals[t[k]] += face * corner_angle(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
            }
        }
    }
    for (std::size_t i = 0; i < broken.size(); ++i) {
        if (broken[i]) {
            primitive.normals[i] = unit_or(primitive.normals[i], Vec3(0, 1, 0));
        }
    }
    return count;
}

} // namespace framelet
