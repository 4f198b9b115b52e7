#include "common/framelet/reprojection.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr Viewport viewport{1280, 720};

glm::dvec3 point_at(ViewRays const& rays, double x, double y, double depth) {
    glm::dvec3 const direction =
        glm::dvec3(rays.direction) + x * glm::dvec3(rays.direction_dx) + y * glm::dvec3(rays.direction_dy);
    return glm::dvec3(rays.origin) + depth * direction;
}

/// Pixel and depth of a world point, from the camera's axes: has nothing in common with what is tested.
glm::dvec3 project(Camera const& camera, glm::dvec3 point) {
    glm::dvec3 const from = point - glm::dvec3(camera.position);
    double const depth = glm::dot(from, glm::dvec3(camera.forward()));
    double const focal = viewport.height / (2 * std::tan(0.5 * camera.vertical_extent));
    return {0.5 * viewport.width + focal * glm::dot(from, glm::dvec3(camera.right())) / depth,
            0.5 * viewport.height - focal * glm::dot(from, glm::dvec3(camera.up())) / depth, depth};
}

/// The layer of a tile at `corner` that shows the plane through `anchor` with `normal`.
Layer layer_of(ViewRays const& rays, glm::dvec2 corner, glm::dvec3 anchor, glm::dvec3 normal) {
    double const distance = glm::dot(anchor - glm::dvec3(rays.origin), normal);
    auto const inverse_depth = [&](double x, double y) {
        return glm::dot(point_at(rays, x, y, 1) - glm::dvec3(rays.origin), normal) / distance;
    };
    double const at = inverse_depth(corner.x, corner.y);
    Layer layer;
    layer.at = static_cast<float>(at);
    layer.dx = static_cast<float>(inverse_depth(corner.x + 1, corner.y) - at);
    layer.dy = static_cast<float>(inverse_depth(corner.x, corner.y + 1) - at);
    return layer;
}

struct Scene {
    Camera source = look_at(Vec3(0, 2, 8), Vec3(0, 1, 0), Vec3(0, 1, 0), 0.8f);
    Camera display = look_at(Vec3(1.2f, 2.3f, 7.1f), Vec3(0.1f, 1, 0), Vec3(0, 1, 0), 0.8f);
    ViewRays from = make_view_rays(source, viewport);
    ViewRays to = make_view_rays(display, viewport);
};

/// Checks samples of a tile's plane against the projection of the points that they show.
void expect_exact(Scene const& scene, Motion const& motion, glm::dvec3 drift, glm::dvec3 normal) {
    glm::dvec2 const corner(672, 400);
    Layer const layer = layer_of(scene.from, corner, glm::dvec3(0.3, 0.5, 0.4), normal);
    auto const plane = make_plane_transform(make_view_transform(scene.from, scene.to, motion, drift), layer, corner);
    ASSERT_TRUE(plane);
    for (double y = 0.5; y < 16; y += 5) {
        for (double x = 0.5; x < 16; x += 5) {
            double const w = layer.at + layer.dx * x + layer.dy * y;
            glm::dvec3 const world = point_at(scene.from, corner.x + x, corner.y + y, 1 / w);
            glm::dvec3 const expected = project(scene.display, motion.linear * world + motion.offset + drift);
            glm::dvec3 const mapped = plane->to_display * glm::dvec3(x, y, 1);
            EXPECT_NEAR(mapped.x / mapped.z, expected.x, 1e-3);
            EXPECT_NEAR(mapped.y / mapped.z, expected.y, 1e-3);
            EXPECT_NEAR(mapped.z / w, expected.z, 1e-5 * expected.z);
            glm::dvec3 const display(expected.x, expected.y, 1);
            glm::dvec3 const back = plane->to_source * display;
            EXPECT_NEAR(back.x / back.z, x, 1e-3);
            EXPECT_NEAR(back.y / back.z, y, 1e-3);
            EXPECT_NEAR(glm::dot(plane->inverse_depth, display), 1 / expected.z, 1e-5 / expected.z);
        }
    }
}

TEST(Reprojection, PlanesAreExactUnderTranslation) {
    expect_exact({}, {}, {}, glm::normalize(glm::dvec3(0.2, 0.3, 1)));
    expect_exact({}, {}, {}, glm::normalize(glm::dvec3(-0.5, 1, 0.2)));
    Scene far_away;
    far_away.source.position += Vec3(900, 0, -700);
    far_away.display = far_away.source;
    far_away.display.position += Vec3(0.25f, 0.125f, -0.5f);
    far_away.from = make_view_rays(far_away.source, viewport);
    far_away.to = make_view_rays(far_away.display, viewport);
    Layer const layer{0.125f, 1e-5f, -2e-5f, 0, static_body, {}};
    auto const plane = make_plane_transform(make_view_transform(far_away.from, far_away.to), layer, {320, 160});
    ASSERT_TRUE(plane);
    glm::dvec3 const mapped = plane->to_display * glm::dvec3(8, 8, 1);
    double const w = 0.125 + 8e-5 - 16e-5;
    glm::dvec3 const expected = project(far_away.display, point_at(far_away.from, 328, 168, 1 / w));
    EXPECT_NEAR(mapped.x / mapped.z, expected.x, 1e-3);
    EXPECT_NEAR(mapped.y / mapped.z, expected.y, 1e-3);
}

TEST(Reprojection, MovingAndDeformingPlanesAreExact) {
    Motion motion;
    motion.linear = glm::dmat3(glm::mat3_cast(glm::angleAxis(0.3f, glm::normalize(Vec3(0.2f, 1, 0)))));
    motion.offset = glm::dvec3(0.4, 0.1, -0.3);
    expect_exact({}, motion, {}, glm::normalize(glm::dvec3(0.2, 0.3, 1)));
    expect_exact({}, motion, {0.05, -0.02, 0.1}, glm::normalize(glm::dvec3(0.2, 0.3, 1)));
}

TEST(Reprojection, RotationNeedsNoDepth) {
    Scene scene;
    scene.display = scene.source;
    scene.display.orientation =
        glm::normalize(glm::angleAxis(0.2f, glm::normalize(Vec3(0.1f, 1, 0.3f))) * scene.source.orientation);
    scene.to = make_view_rays(scene.display, viewport);
    ViewTransform const transform = make_view_transform(scene.from, scene.to);
    for (double const w : {0.0, 1e-3, 0.5, 10.0}) {
        for (double x = 0; x <= viewport.width; x += 160) {
            glm::dvec3 const mapped = transform.map(x, 0.4 * x, w);
            glm::dvec3 const expected =
                project(scene.display, point_at(scene.from, x, 0.4 * x, 1000)); // depth makes no difference
            EXPECT_NEAR(mapped.x / mapped.z, expected.x, 1e-3);
            EXPECT_NEAR(mapped.y / mapped.z, expected.y, 1e-3);
        }
    }
}

TEST(Reprojection, SameViewIsIdentity) {
    Scene scene;
    ViewTransform const transform = make_view_transform(scene.from, scene.from);
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            EXPECT_NEAR(transform.far[column][row], column == row ? 1 : 0, 1e-9);
        }
        EXPECT_EQ(transform.parallax[column], 0);
    }
}

TEST(Reprojection, PlanesSeenEdgeOnOrFromBehindAreLeftOut) {
    Scene scene; // looks down -Z at a plane at z = 0
    Layer const layer = layer_of(scene.from, {640, 360}, {0, 0, 0}, {0, 0, 1});
    for (float const z : {4.0f, 0.5f, 0.0f, -1.0f, -8.0f}) {
        Camera display = scene.source;
        display.position.z = z;
        auto const plane =
            make_plane_transform(make_view_transform(scene.from, make_view_rays(display, viewport)), layer, {640, 360});
        EXPECT_EQ(plane.has_value(), z > 0) << z;
    }
}

TEST(Reprojection, BoxesHoldWhatTheyShouldAndAreNeverStrange) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    int shown = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::dmat3 map(1);
        map[2] = {300 + 400 * normal(random), 300 + 300 * normal(random), 1 + normal(random)};
        for (int column = 0; column < 2; ++column) {
            map[column] += glm::dvec3(normal(random), normal(random), 0.05 * normal(random));
        }
        PixelRect const box = display_box(map, {-1, -1}, {17, 17}, viewport);
        EXPECT_TRUE(box.left >= 0 && box.top >= 0 && box.right <= viewport.width && box.bottom <= viewport.height);
        for (double x = -1; x <= 17; x += 2) {
            glm::dvec3 const point = map * glm::dvec3(x, 0.7 * x, 1);
            double const px = point.x / point.z;
            double const py = point.y / point.z;
            if (point.z > 0.01 && px > 0 && py > 0 && px < viewport.width && py < viewport.height) {
                ++shown;
                // Half a pixel farther there is the centre of a pixel that the box holds, or of one in which nothing
                // need show.
                EXPECT_TRUE(box.left - 0.5 <= px && box.top - 0.5 <= py && box.right + 0.5 >= px &&
                            box.bottom + 0.5 >= py);
            }
        }
    }
    EXPECT_GT(shown, 1000);
    EXPECT_TRUE(display_box(glm::dmat3(NAN), {0, 0}, {16, 16}, viewport).empty());
    EXPECT_TRUE(display_box(glm::dmat3(0), {0, 0}, {16, 16}, viewport).empty());
    glm::dmat3 behind(1);
    behind[2].z = -1;
    EXPECT_TRUE(display_box(behind, {0, 0}, {16, 16}, viewport).empty());
}

} // namespace
} // namespace framelet
