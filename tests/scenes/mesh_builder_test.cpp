#include "scenes/mesh/mesh_builder.h"

#include <array>

#include <gtest/gtest.h>

namespace framelet {
namespace {

D3 face_cross(MeshData const& mesh, std::size_t i) {
    D3 const& a = mesh.positions[mesh.indices[i]];
    return glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
}

/// Volume by the divergence theorem; negative where the faces look inward, wrong where the surface has a hole.
double volume(MeshData const& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        sum += glm::dot(mesh.positions[mesh.indices[i]] + D3(5, 7, 3), face_cross(mesh, i)) / 6;
    }
    return sum;
}

void expect_normals_on_the_outside(MeshData const& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        D3 const& normal = mesh.normals[mesh.indices[i]];
        EXPECT_NEAR(glm::length(normal), 1, 1e-9);
        EXPECT_GT(glm::dot(normal, glm::normalize(face_cross(mesh, i / 3 * 3))), 0.5) << "index " << i;
    }
}

TEST(MeshBuilder, SolidsAreClosedAndHaveTheirVolume) {
    EXPECT_NEAR(volume(make_box({2, 3, 4})), 24, 1e-9);
    EXPECT_NEAR(volume(make_sphere(1.5, 96)), 4.0 / 3 * pi * 1.5 * 1.5 * 1.5, 0.05);
    EXPECT_NEAR(volume(make_cylinder(0.5, 2, 96)), pi * 0.25 * 2, 0.01);
    EXPECT_NEAR(volume(make_torus(2, 0.5, 96, 48)), 2 * pi * pi * 2 * 0.25, 0.1);
    double const r = 0.2; // box: core + faces + quarter cylinders along the edges + one sphere
    double const rounded = 0.6 * 1.6 * 2.6 + 2 * r * (0.6 * 1.6 + 1.6 * 2.6 + 0.6 * 2.6) +
                           pi * r * r * (0.6 + 1.6 + 2.6) + 4.0 / 3 * pi * r * r * r;
    EXPECT_NEAR(volume(make_rounded_box({1, 2, 3}, r)), rounded, 0.02);
}

TEST(MeshBuilder, NormalsAreUnitAndOutward) {
    expect_normals_on_the_outside(make_box({2, 3, 4}));
    expect_normals_on_the_outside(make_rounded_box({1, 2, 3}, 0.2));
    expect_normals_on_the_outside(make_sphere(1, 32));
    expect_normals_on_the_outside(make_cylinder(0.5, 2, 24));
    expect_normals_on_the_outside(make_cone(0.5, 2, 24));
    expect_normals_on_the_outside(make_torus(2, 0.5, 32, 16));
    expect_normals_on_the_outside(make_ground({3, 4}, 1));
    expect_normals_on_the_outside(make_card({1, 2}));
}

TEST(MeshBuilder, LatheKeepsSharpCornersAndSmoothsOthers) {
    std::array<D2, 3> const sharp{D2(1, 0), D2(1, 1), D2(0, 1)};
    for (D3 const& normal : make_lathe(sharp, 8).normals) {
        EXPECT_TRUE(std::abs(normal.y) < 1e-9 || std::abs(normal.y) > 1 - 1e-9);
    }
    std::array<D2, 3> const gentle{D2(1, 0), D2(1, 1), D2(0.8, 2)};
    bool between = false;
    for (D3 const& normal : make_lathe(gentle, 8).normals) {
        between = between || (normal.y > 0.05 && normal.y < 0.15);
    }
    EXPECT_TRUE(between);
}

TEST(MeshBuilder, AppendMovesTurnsAndScales) {
    MeshData mesh = make_box({1, 1, 1});
    append(mesh, make_box({1, 1, 1}), {{10, 0, 0}, rotation_about({0, 1, 0}, pi / 4), {1, 2, 1}});
    EXPECT_NEAR(volume(mesh), 3, 1e-9);
    expect_normals_on_the_outside(mesh);
}

TEST(Noise, RepeatsWithItsPeriodAndStaysInRange) {
    double strongest = 0;
    for (int i = 0; i < 2000; ++i) {
        D2 const at(8 * random_unit(1, i), 8 * random_unit(2, i));
        double const value = fractal_noise(3, at, 4, 8);
        EXPECT_NEAR(value, fractal_noise(3, at + D2(8, -16), 4, 8), 1e-9);
        EXPECT_LE(std::abs(value), 1);
        strongest = std::max(strongest, std::abs(value));
    }
    EXPECT_GT(strongest, 0.4);
}

} // namespace
} // namespace framelet
