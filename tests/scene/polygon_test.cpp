#include "server/scene/assimp/polygon.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// Area that the triangles cover, those wound against `normal` counted negative.
float covered(std::vector<Vec3> const& corners, Vec3 const& normal) {
    float sum = 0;
    for (auto const& [a, b, c] : triangulate(corners)) {
        sum += 0.5f * glm::dot(glm::cross(corners[b] - corners[a], corners[c] - corners[a]), normal);
    }
    return sum;
}

/// The same with every triangle counted positive: equal only where none overlap.
float total(std::vector<Vec3> const& corners) {
    float sum = 0;
    for (auto const& [a, b, c] : triangulate(corners)) {
        sum += 0.5f * glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a]));
    }
    return sum;
}

TEST(Polygon, ConcaveOnesAreCoveredOnce) {
    // An arrow head whose first corner is the concave one, in three planes.
    std::vector<Vec3> const arrow{{0, 1, 0}, {2, 0, 0}, {0, 4, 0}, {-2, 0, 0}};
    EXPECT_EQ(triangulate(arrow).size(), 2u);
    EXPECT_FLOAT_EQ(covered(arrow, {0, 0, 1}), 6);
    EXPECT_FLOAT_EQ(total(arrow), 6);
    std::vector<Vec3> turned;
    for (Vec3 const& p : arrow) {
        turned.emplace_back(3, p.y, p.x); // seen from -x
    }
    EXPECT_FLOAT_EQ(covered(turned, {-1, 0, 0}), 6);
    EXPECT_FLOAT_EQ(total(turned), 6);
    // A comb.
    std::vector<Vec3> const comb{{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 3, 0}, {4, 1, 0}, {3, 1, 0},
                                 {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    EXPECT_EQ(triangulate(comb).size(), 10u);
    EXPECT_FLOAT_EQ(covered(comb, {0, 0, 1}), 11);
    EXPECT_FLOAT_EQ(total(comb), 11);
}

TEST(Polygon, AlwaysAllTriangles) {
    std::vector<Vec3> const crossed{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}, {1, 5, 0}};
    EXPECT_EQ(triangulate(crossed).size(), 3u);
    EXPECT_EQ(triangulate(std::vector<Vec3>(7, Vec3(1, 2, 3))).size(), 5u);
    EXPECT_EQ(triangulate(std::vector<Vec3>(5, Vec3(NAN))).size(), 3u);
    EXPECT_TRUE(triangulate(std::vector<Vec3>(2)).empty());
    EXPECT_TRUE(triangulate({}).empty());
    std::vector<Vec3> circle;
    for (int i = 0; i < 100000; ++i) {
        float const angle = 6.2831853f * static_cast<float>(i) / 100000;
        circle.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    EXPECT_EQ(triangulate(circle).size(), 99998u);
}

} // namespace
} // namespace framelet
