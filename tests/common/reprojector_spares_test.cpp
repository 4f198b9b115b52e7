#include "common/reprojector.h"

#include <algorithm>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/common/moved_room.h"

namespace framelet {
namespace {

constexpr int half = viewport.width / 2;
/// Of rows at the picture's upper and lower edge: the front camera does not see all that the turned one does there.
constexpr int margin = 16;

Camera turned() {
    Camera camera = front();
    camera.orientation = glm::normalize(camera.orientation * glm::angleAxis(0.15f, Vec3(0, 1, 0)));
    return camera;
}

std::vector<Tile> tiles(ImagePlane const& plane, bool left) {
    std::vector<Tile> out = visible_tiles(plane, plane.pixel_depth());
    std::erase_if(out, [&](Tile tile) { return (plane.tile_rect(tile).left < half) != left; });
    return out;
}

/// All was seen from the front, or only the right half; then the camera turned to the left and the left half arrived.
FrameletCache seen_twice(bool all) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    if (all) {
        cache.insert(room().batch(plane, 1, front(), 0, tiles(plane, true)));
    }
    cache.insert(room().batch(plane, 2, front(), 0, tiles(plane, false)));
    cache.insert(room().batch(plane, 3, turned(), 0, tiles(plane, true)));
    return cache;
}

TEST(ReprojectorSpares, ShowWhatNobodyHasSentAgain) {
    Shown const without = show(seen_twice(false), turned(), 0);
    Shown const with = show(seen_twice(true), turned(), 0);
    ViewRays const rays = make_view_rays(turned(), viewport);
    int holes = 0;
    for (int y = margin; y < viewport.height - margin; ++y) {
        for (int x = half; x < half + 32; ++x) {
            holes += without.inverse_depth[at(x, y)] == hole_depth ? 1 : 0;
            ASSERT_NE(with.inverse_depth[at(x, y)], hole_depth) << x << " " << y;
        }
    }
    EXPECT_GT(holes, viewport.height * 8);
    AnalyticScene const scene = room();
    std::vector<Quad> const placed = scene.at_time(0);
    int right = 0, filled = 0;
    for (int y = margin; y < viewport.height - margin; ++y) {
        for (int x = half; x < half + 32; ++x) {
            if (without.inverse_depth[at(x, y)] == hole_depth) {
                double const expected = scene.cast(placed, rays, x + 0.5, y + 0.5).inverse_depth;
                ++filled;
                right += std::abs(static_cast<double>(with.inverse_depth[at(x, y)]) - expected) <= 0.01 * expected;
            }
        }
    }
    EXPECT_GE(right, 0.97 * filled);
    EXPECT_LT(with.hole_share, without.hole_share - 0.05);
}

TEST(ReprojectorSpares, ChangeNothingWhereSomethingShows) {
    Shown const without = show(seen_twice(false), turned(), 0);
    Shown const with = show(seen_twice(true), turned(), 0);
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            if (without.inverse_depth[at(x, y)] != hole_depth) {
                ASSERT_EQ(with.inverse_depth[at(x, y)], without.inverse_depth[at(x, y)]) << x << " " << y;
                ASSERT_TRUE(std::equal(with.picture.row(y) + 4 * x, with.picture.row(y) + 4 * x + 4,
                                       without.picture.row(y) + 4 * x))
                    << x << " " << y;
            }
        }
    }
}

/// What is shown is a function of what is held, whatever was shown before.
TEST(ReprojectorSpares, ArriveInBlocksThatStayAsTheyWere) {
    ImagePlane const plane(viewport);
    FrameletCache cache(plane);
    Reprojector reprojector;
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed, repainted;
    auto const show_now = [&] {
        cache.take_changed(changed);
        reprojector.show(cache, changed, turned(), 0, {}, picture, repainted);
    };
    cache.insert(room().batch(plane, 1, front(), 0, tiles(plane, true)));
    show_now();
    cache.insert(room().batch(plane, 2, front(), 0, tiles(plane, false)));
    show_now();
    for (Tile const tile : tiles(plane, true)) {
        cache.insert(room().batch(plane, 3 + tile.code, turned(), 0, {tile}));
        show_now();
    }
    EXPECT_EQ(picture, show(cache, turned(), 0).picture);
}

/// Something stood beside a post when it was seen first and is gone when all is seen again from elsewhere. What then
/// comes out behind the post is not that.
TEST(ReprojectorSpares, ShowNothingNearInWhatComesOutBehindSomething) {
    auto const camera_at = [](float x) { return look_at({x, 1, 6}, {x, 1, 0}, {0, 1, 0}, 0.8f); };
    AnalyticScene now;
    now.quads.push_back({{-20, -20, -3}, {40, 0, 0}, {0, 40, 0}, waves(12, 6)});
    now.quads.push_back({{-0.3, -20, 2}, {0.6, 0, 0}, {0, 40, 0}, waves(2, 2)});
    AnalyticScene before = now;
    before.quads.push_back({{0.3, -20, 1.5}, {0.6, 0, 0}, {0, 40, 0}, waves(2, 2)});
    ImagePlane const plane(viewport);
    std::vector<Tile> const all = visible_tiles(plane, plane.pixel_depth());
    std::span const most(all.begin() + 1, all.end()); // once all is of one camera there are no spares
    FrameletCache cache(plane);
    cache.insert(before.batch(plane, 1, camera_at(0), 0, all));
    cache.insert(now.batch(plane, 2, camera_at(0.6f), 0, {most.begin(), most.end()}));
    ASSERT_EQ(cache.spares().size(), most.size());
    Shown const with = show(cache, camera_at(0.9f), 0);
    auto const count_at = [&with](float depth) {
        return std::ranges::count_if(with.inverse_depth, [&](float w) { return std::abs(w * depth - 1) < 0.05f; });
    };
    EXPECT_GT(count_at(4), viewport.height * 30); // the post
    EXPECT_EQ(count_at(4.5f), 0); // what is gone
    EXPECT_GT(std::ranges::count(with.inverse_depth, hole_depth), viewport.height * 3);
}

} // namespace
} // namespace framelet
