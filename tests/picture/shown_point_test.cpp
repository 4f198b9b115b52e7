#include "common/picture/shown_point.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

/// The position in the picture at which a point of the world is seen, pixels.
Vec2 position_of(Camera const& camera, Vec3 point) {
    Vec3 const seen = glm::conjugate(camera.orientation) * (point - camera.position);
    float const pixels = 0.5f * static_cast<float>(viewport.height) / std::tan(0.5f * camera.vertical_extent);
    return Vec2(0.5f * viewport.width, 0.5f * viewport.height) + Vec2(seen.x, -seen.y) * (pixels / -seen.z);
}

Camera aside() {
    Camera out = front();
    out.position.x += 0.4f;
    return out;
}

TEST(ShownPoint, IsWhereTheSurfaceIsFromWhereverItIsSeen) {
    FrameletPool const pool = filled(room(), front(), 0);
    Vec3 const on_wall(-2, 2, -3);
    Vec3 const on_floor(1, 0, 2);
    Vec3 const on_board(-0.1f, 1, 1.15f); // the middle of its quad
    for (Camera const& camera : {front(), aside()}) {
        for (Vec3 const point : {on_wall, on_floor, on_board}) {
            std::optional<Vec3> const found = find_shown_point(pool, camera, 0, {}, position_of(camera, point));
            ASSERT_TRUE(found);
            EXPECT_LT(glm::distance(*found, point), 0.03f) << found->x << ' ' << found->y << ' ' << found->z;
        }
    }
}

TEST(ShownPoint, IsKnownWhereSomethingIsShownOrNearThat) {
    FrameletPool const pool = filled(room(), front(), 0);
    Shown const shown = show(pool, aside(), 0);
    int holes = 0;
    int known_holes = 0;
    for (int y = 3; y < viewport.height; y += 8) {
        for (int x = 0; x < viewport.width; ++x) {
            Vec2 const position = Vec2(x, y) + 0.5f;
            bool const is_hole = shown.inverse_depth[at(x, y)] == hole_depth;
            bool const is_known = find_shown_point(pool, aside(), 0, {}, position).has_value();
            bool const is_far = shown.inverse_depth[at(x, y)] == 0;
            if (is_hole) {
                ++holes;
                known_holes += is_known ? 1 : 0;
            } else {
                ASSERT_EQ(is_known, !is_far) << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(known_holes, 0);
    EXPECT_LT(known_holes, holes);
}

TEST(ShownPoint, OfNothingAndOutsideIsNone) {
    FrameletPool const nothing{ImagePlane(viewport)};
    EXPECT_FALSE(find_shown_point(nothing, front(), 0, {}, {100, 100}));
    FrameletPool const pool = filled(room(), front(), 0);
    for (Vec2 const position :
         {Vec2(-1, 5), Vec2(5, -1), Vec2(viewport.width, 5), Vec2(5, viewport.height), Vec2(NAN)}) {
        EXPECT_FALSE(find_shown_point(pool, front(), 0, {}, position));
    }
}

TEST(ShownDepths, AreThoseOfTheShownPoints) {
    FrameletPool const pool = filled(room(), front(), 0);
    for (Camera const& camera : {front(), aside()}) {
        std::vector<float> const depths = find_shown_depths(pool, camera, 0, {});
        ASSERT_EQ(depths.size(), static_cast<std::size_t>(viewport.width) * viewport.height);
        for (int y = 3; y < viewport.height; y += 8) {
            for (int x = 2; x < viewport.width; x += 5) {
                std::optional<Vec3> const point = find_shown_point(pool, camera, 0, {}, Vec2(x, y) + 0.5f);
                float const depth = depths[at(x, y)];
                if (point) {
                    EXPECT_NEAR(depth, glm::dot(*point - camera.position, camera.forward()), 1e-3f * depth);
                } else {
                    EXPECT_TRUE(depth == 0 || std::isinf(depth)) << x << ' ' << y << ": " << depth;
                }
            }
        }
    }
}

TEST(ShownDepths, OfNothingAreNone) {
    EXPECT_TRUE(find_shown_depths(FrameletPool{ImagePlane(viewport)}, front(), 0, {}).empty());
}

TEST(ShownDepths, OfFrameletsWithoutShapesAreNone) {
    ImagePlane const plane(viewport);
    Batch batch = room().batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth()), false);
    batch.shapes.clear();
    FrameletPool pool(plane);
    pool.insert(batch, {});
    EXPECT_TRUE(find_shown_depths(pool, front(), 0, {}).empty());
}

} // namespace
} // namespace framelet
