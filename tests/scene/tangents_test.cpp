#include "server/scene/finish/tangents.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// A quad in the xy plane facing +z; its texture upright (v points down) or mirrored.
Primitive quad(bool mirrored) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    p.normals.assign(4, Vec3(0, 0, 1));
    p.uv[0] = mirrored ? std::vector<Vec2>{{1, 1}, {0, 1}, {0, 0}, {1, 0}}
                       : std::vector<Vec2>{{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    return p;
}

TEST(Tangents, PointAlongUAndTheBitangentUpTheImage) {
    Primitive p = quad(false);
    make_tangents(p, p.uv[0]);
    for (Vec4 const& tangent : p.tangents) {
        EXPECT_NEAR(glm::distance(tangent, Vec4(1, 0, 0, 1)), 0, 1e-6f);
    }
    p = quad(true);
    make_tangents(p, p.uv[0]);
    for (Vec4 const& tangent : p.tangents) {
        EXPECT_NEAR(glm::distance(tangent, Vec4(-1, 0, 0, -1)), 0, 1e-6f);
        Vec3 const bitangent = glm::cross(Vec3(0, 0, 1), Vec3(tangent)) * tangent.w;
        EXPECT_GT(bitangent.y, 0.99f);
    }
}

TEST(Tangents, VerticesBetweenMirroredHalvesAreSplit) {
    // Two quads that share an edge at x = 1, where the texture is reflected.
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    p.normals.assign(6, Vec3(0, 0, 1));
    p.uv[0] = {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}};
    p.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    std::vector<Vec2> const uv = p.uv[0];
    make_tangents(p, uv);
    ASSERT_EQ(p.positions.size(), 8u);
    ASSERT_EQ(p.tangents.size(), 8u);
    for (std::size_t t = 0; t < 4; ++t) {
        Vec4 const expected = t < 2 ? Vec4(1, 0, 0, 1) : Vec4(-1, 0, 0, -1);
        for (std::uint32_t const v : p.triangles[t]) {
            EXPECT_NEAR(glm::distance(p.tangents[v], expected), 0, 1e-6f) << "triangle " << t;
        }
    }
}

TEST(Tangents, AlikeVerticesShareOneTangentThoughStoredTwice) {
    // A bent strip: unindexed and indexed give the same.
    Primitive indexed;
    indexed.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 1}, {2, 1, 1}};
    indexed.normals.assign(6, Vec3(0, 0, 1));
    indexed.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {2, 0.8f}, {2, -0.3f}};
    indexed.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    Primitive loose;
    for (auto const& triangle : indexed.triangles) {
        auto const first = static_cast<std::uint32_t>(loose.positions.size());
        for (std::uint32_t const v : triangle) {
            loose.positions.push_back(indexed.positions[v]);
            loose.normals.push_back(indexed.normals[v]);
            loose.uv[0].push_back(indexed.uv[0][v]);
        }
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    std::vector<Vec2> const indexed_uv = indexed.uv[0];
    std::vector<Vec2> const loose_uv = loose.uv[0];
    make_tangents(indexed, indexed_uv);
    make_tangents(loose, loose_uv);
    for (std::size_t t = 0; t < 4; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(indexed.tangents[indexed.triangles[t][k]], loose.tangents[loose.triangles[t][k]]);
        }
    }
}

TEST(Tangents, WithoutTextureAreaSomeFrame) {
    Primitive p = quad(false);
    make_tangents(p, std::vector<Vec2>(4, Vec2(0.5f)));
    for (Vec4 const& tangent : p.tangents) {
        EXPECT_NEAR(glm::length(Vec3(tangent)), 1, 1e-6f);
        EXPECT_NEAR(tangent.z, 0, 1e-6f);
    }
}

TEST(Tangents, BrokenOnesOfAFileAreRepaired) {
    Primitive p = quad(false);
    p.tangents = {{2, 0, 0, 1}, {NAN, 0, 0, 1}, {0, 0, 0, -1}, {0, 3, 0, -0.5f}};
    repair_tangents(p);
    EXPECT_EQ(p.tangents[0], Vec4(1, 0, 0, 1));
    EXPECT_NEAR(glm::length(Vec3(p.tangents[1])), 1, 1e-6f);
    EXPECT_EQ(p.tangents[2].w, -1);
    EXPECT_EQ(p.tangents[3], Vec4(0, 1, 0, -1));
}

} // namespace
} // namespace framelet
