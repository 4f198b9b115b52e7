#include "server/scene/finish/normals.h"

#include <gtest/gtest.h>

#include "server/scene/finish/primitive_ops.h"

namespace framelet {
namespace {

TEST(Normals, FlatOnesFollowMorphTargets) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.morph_targets.push_back({{{0, 0, 0}, {0, 0, 0}, {0, -1, 1}, {0, 0, 0}}, {}, {}});
    make_flat_normals(p);
    ASSERT_EQ(p.positions.size(), 6u);
    EXPECT_EQ(p.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(p.normals[3], Vec3(1, 0, 0));
    EXPECT_EQ(p.normals[0] + p.morph_targets[0].normals[0], Vec3(0, -1, 0)) << "the triangle is in the xz plane then";
}

TEST(Normals, BrokenOnesAreTheAngleWeightedMean) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 4, 4}};
    p.normals = {Vec3(0), Vec3(0, 0, 9), Vec3(NAN), Vec3(1, 0, 0), Vec3(0)};
    EXPECT_EQ(repair_normals(p), 3u);
    Vec3 const mean = glm::normalize(Vec3(1, 0, 1));
    EXPECT_NEAR(glm::distance(p.normals[0], mean), 0, 1e-6f) << "two right angles";
    EXPECT_EQ(p.normals[1], Vec3(0, 0, 1));
    EXPECT_NEAR(glm::distance(p.normals[2], mean), 0, 1e-6f);
    EXPECT_NEAR(glm::length(p.normals[4]), 1, 1e-6f) << "a degenerate triangle still has some normal";
}

TEST(PrimitiveOps, UnusedVerticesAreDroppedFromEveryAttribute) {
    Primitive p;
    p.positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {0, 1, 0}};
    p.uv[0] = {{9, 9}, {0, 0}, {1, 0}, {9, 9}, {0, 1}};
    p.influences.resize(5);
    p.influences[4].joints[0] = 7;
    p.morph_targets.push_back({std::vector<Vec3>(5, Vec3(1)), {}, {}});
    p.triangles = {{1, 2, 4}};
    p.material = 3;
    drop_unused_vertices(p);
    EXPECT_EQ(p.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(p.uv[0], (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(p.influences[2].joints[0], 7);
    EXPECT_EQ(p.morph_targets[0].positions.size(), 3u);
    EXPECT_EQ(p.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(p.material, 3);
}

} // namespace
} // namespace framelet
