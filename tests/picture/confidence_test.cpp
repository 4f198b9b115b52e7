#include "common/picture/confidence.h"

#include <algorithm>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

std::vector<PixelConfidence> confidence(FrameletPool const& pool, Camera const& camera, SceneTime time) {
    std::vector<PixelConfidence> out;
    find_confidence(pool, camera, time, {}, out);
    EXPECT_EQ(out.size(), static_cast<std::size_t>(viewport.width) * viewport.height);
    return out;
}

bool is_made_up(PixelConfidence const& pixel) {
    return pixel.seconds == PixelConfidence::made_up;
}

TEST(Confidence, SaysHowOldAndHowCoarse) {
    for (int const levels : {-2, -1, 0, 1, 2}) {
        FrameletPool const pool = filled(room(), front(), levels, 3);
        for (PixelConfidence const& pixel : confidence(pool, front(), 3.5)) {
            ASSERT_FLOAT_EQ(pixel.seconds, 0.5f);
            ASSERT_FLOAT_EQ(pixel.spacing, std::exp2(static_cast<float>(-levels)));
        }
    }
}

TEST(Confidence, OfTwoTheOneThatShows) {
    ImagePlane const plane(viewport);
    FrameletPool pool = filled(room(), front(), 0, 1);
    Tile const tile = make_tile(plane.pixel_depth(), 4, 5);
    pool.insert(room().batch(plane, 2, front(), 2, {tile}), {});
    std::vector<PixelConfidence> const found = confidence(pool, front(), 2.25);
    PixelRect const rect = plane.tile_rect(tile);
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            bool const fresh = x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom;
            ASSERT_FLOAT_EQ(found[at(x, y)].seconds, fresh ? 0.25f : 1.25f) << x << ' ' << y;
        }
    }
}

/// The holes of the picture that is shown are made up, and nothing else is.
TEST(Confidence, HolesAreMadeUp) {
    Camera moved = front();
    moved.position.x += 0.4f;
    FrameletPool const pool = filled(room(), front(), 0);
    Shown const shown = show(pool, moved, 0);
    std::vector<PixelConfidence> const found = confidence(pool, moved, 0);
    EXPECT_TRUE(std::ranges::any_of(found, is_made_up));
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(is_made_up(found[i]), shown.inverse_depth[i] == hole_depth) << i;
    }
}

TEST(Confidence, IsOfEachMomentThatShows) {
    ImagePlane const plane(viewport);
    Camera turned = front();
    turned.orientation = glm::normalize(turned.orientation * glm::angleAxis(0.15f, Vec3(0, 1, 0)));
    std::vector<Tile> left = visible_tiles(plane, plane.pixel_depth());
    std::erase_if(left, [&](Tile tile) { return plane.tile_rect(tile).left >= viewport.width / 2; });
    FrameletPool pool = filled(room(), front(), 0, 1);
    pool.insert(room().batch(plane, 2, turned, 2, left), {});
    Shown const shown = show(pool, turned, 2);
    std::vector<PixelConfidence> const found = confidence(pool, turned, 2);
    auto const is_older = [](PixelConfidence const& pixel) { return pixel.seconds == 1; };
    auto const is_newer = [](PixelConfidence const& pixel) { return pixel.seconds == 0; };
    EXPECT_GT(std::ranges::count_if(found, is_older), viewport.height * 8);
    EXPECT_GT(std::ranges::count_if(found, is_newer), viewport.height * 8);
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(is_made_up(found[i]), shown.inverse_depth[i] == hole_depth) << i;
    }
}

TEST(Confidence, OfNothingIsNone) {
    FrameletPool const pool{ImagePlane(viewport)};
    EXPECT_TRUE(std::ranges::all_of(confidence(pool, front(), 0), is_made_up));
}

} // namespace
} // namespace framelet
