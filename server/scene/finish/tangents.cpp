#include "server/scene/finish/tangents.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "common/error.h"
#include "common/mix_bits.h"
#include "server/scene/finish/primitive_ops.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

struct VertexKey {
    Vec3 position, normal;
    Vec2 uv;

    bool operator==(VertexKey const&) const = default;
};

std::size_t hash_of(VertexKey const& key) {
    std::array<std::uint32_t, 8> words{};
    std::array<float, 8> values{key.position.x, key.position.y, key.position.z, key.normal.x,
                                key.normal.y,   key.normal.z,   key.uv.x,       key.uv.y};
    for (float& value : values) {
        value += 0.0f; // -0 equals 0
    }
    std::memcpy(words.data(), values.data(), sizeof(words));
    std::uint64_t hash = 0;
    for (std::uint32_t const word : words) {
        hash = mix_in(hash, word);
    }
    return hash;
}

/// Finds for every vertex the first one that is alike.
std::vector<std::uint32_t> find_alike(Primitive const& primitive, std::span<Vec2 const> uv) {
    std::size_t const count = primitive.positions.size();
    std::size_t table_size = 16;
    while (table_size < count * 2) {
        table_size *= 2;
    }
    constexpr std::uint32_t empty = ~0u;
    std::vector<std::uint32_t> table(table_size, empty);
    std::vector<std::uint32_t> alike(count);
    auto const key = [&](std::uint32_t i) { return VertexKey{primitive.positions[i], primitive.normals[i], uv[i]}; };
    for (std::uint32_t i = 0; i < count; ++i) {
        std::size_t slot = hash_of(key(i)) & (table_size - 1);
        while (table[slot] != empty && !(key(table[slot]) == key(i))) {
            slot = (slot + 1) & (table_size - 1);
        }
        if (table[slot] == empty) {
            table[slot] = i;
        }
        alike[i] = table[slot];
    }
    return alike;
}

enum Side : std::size_t { straight = 0, mirrored = 1 };

struct TriangleTangent {
    Vec3 direction{0}; ///< of increasing u; 0 where the texture coordinates span no area
    Side side = straight;
};

TriangleTangent triangle_tangent(Primitive const& primitive, std::span<Vec2 const> uv,
                                 std::array<std::uint32_t, 3> const& t) {
    Vec3 const d1 = primitive.positions[t[1]] - primitive.positions[t[0]];
    Vec3 const d2 = primitive.positions[t[2]] - primitive.positions[t[0]];
    glm::dvec2 const t1 = glm::dvec2(uv[t[1]]) - glm::dvec2(uv[t[0]]);
    glm::dvec2 const t2 = glm::dvec2(uv[t[2]]) - glm::dvec2(uv[t[0]]);
    double const area = t1.x * t2.y - t1.y * t2.x;
    if (area == 0) {
        return {};
    }
    glm::dvec3 const direction = (glm::dvec3(d1) * t2.y - glm::dvec3(d2) * t1.y) * (area > 0 ? 1.0 : -1.0);
    double const length = glm::length(direction);
    // v points down the image and the bitangent up, so a texture seen the right way round has a negative area.
    return {length > 0 ? Vec3(direction / length) : Vec3(0), area > 0 ? mirrored : straight};
}

Vec3 project(Vec3 const& v, Vec3 const& normal) {
    return v - normal * glm::dot(normal, v);
}

} // namespace

void make_tangents(Primitive& primitive, std::span<Vec2 const> uv) {
    FRAMELET_CHECK(uv.size() == primitive.positions.size() && primitive.normals.size() == uv.size());
    std::vector<std::uint32_t> const alike = find_alike(primitive, uv);
    std::array<std::vector<Vec3>, 2> sums{std::vector<Vec3>(uv.size()), std::vector<Vec3>(uv.size())};
    std::vector<TriangleTangent> tangents;
    tangents.reserve(primitive.triangles.size());
    for (auto const& t : primitive.triangles) {
        TriangleTangent const tangent = triangle_tangent(primitive, uv, t);
        tangents.push_back(tangent);
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 const normal = primitive.normals[t[k]];
            Vec3 const corner = primitive.positions[t[k]];
            float const angle = corner_angle(Vec3(0), project(primitive.positions[t[(k + 1) % 3]] - corner, normal),
                                             project(primitive.positions[t[(k + 2) % 3]] - corner, normal));
            sums[tangent.side][alike[t[k]]] += unit_or(project(tangent.direction, normal), Vec3(0)) * angle;
        }
    }

    // A vertex keeps its index for the side it is first used on, and is copied for the other.
    std::vector<std::uint32_t> source(uv.size());
    std::iota(source.begin(), source.end(), 0u);
    constexpr std::uint32_t unused = ~0u;
    std::array<std::vector<std::uint32_t>, 2> vertex_of{std::vector<std::uint32_t>(uv.size(), unused),
                                                        std::vector<std::uint32_t>(uv.size(), unused)};
    std::vector<Side> side_of(uv.size(), straight);
    std::vector<std::array<std::uint32_t, 3>> triangles = std::move(primitive.triangles);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Side const side = tangents[i].side;
        for (std::uint32_t& vertex : triangles[i]) {
            std::uint32_t const original = vertex;
            std::uint32_t& mapped = vertex_of[side][original];
            if (mapped == unused) {
                bool const first = vertex_of[straight][original] == vertex_of[mirrored][original];
                mapped = first ? original : static_cast<std::uint32_t>(source.size());
                if (first) {
                    side_of[original] = side;
                } else {
                    source.push_back(original);
                    side_of.push_back(side);
                }
            }
            vertex = mapped;
        }
    }
    if (source.size() > uv.size()) {
        primitive = gather_vertices(primitive, source);
    }
    primitive.triangles = std::move(triangles);
    primitive.tangents.resize(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) {
        Vec3 const normal = primitive.normals[i];
        Vec3 const sum = project(sums[side_of[i]][alike[source[i]]], normal);
        primitive.tangents[i] = Vec4(unit_or(sum, any_perpendicular(normal)), side_of[i] == mirrored ? -1.0f : 1.0f);
    }
}

void repair_tangents(Primitive& primitive) {
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
        Vec4& tangent = primitive.tangents[i];
        Vec3 const direction = is_finite(tangent) ? Vec3(tangent) : Vec3(0);
        tangent = Vec4(unit_or(direction, any_perpendicular(primitive.normals[i])), tangent.w < 0 ? -1.0f : 1.0f);
    }
}

} // namespace framelet
