// Tests the Reprojector with a canvas: what it asks of one, and what it makes of the answers.
#include "common/picture/block_canvas.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/picture/fake_canvas.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

Camera beside() {
    return look_at(Vec3(0.3f, 1.6f, 5.7f), Vec3(0.1f, 1, 0), Vec3(0, 1, 0), 0.8f);
}

struct Screen {
    Reprojector reprojector;
    Picture picture{viewport.width, viewport.height};
    std::vector<PixelRect> repainted;

    void show(FrameletPool const& pool, Camera const& camera, BlockCanvas* canvas) {
        reprojector.show(pool, {}, camera, 0, {}, picture, repainted, canvas);
    }
};

TEST(BlockCanvas, WhatIsReportedCountsAsWhatIsPaintedInMemory) {
    FrameletPool const pool = filled(room(), front(), 0);
    FakeCanvas canvas;
    Screen memory, elsewhere;
    memory.show(pool, beside(), nullptr);
    elsewhere.show(pool, beside(), &canvas);
    EXPECT_TRUE(elsewhere.reprojector.is_on_canvas());
    EXPECT_FALSE(memory.reprojector.is_on_canvas());
    EXPECT_EQ(elsewhere.reprojector.hole_share(), memory.reprojector.hole_share());
    EXPECT_GT(elsewhere.reprojector.hole_share(), 0);
    EXPECT_TRUE(std::ranges::equal(elsewhere.reprojector.shown_blocks(), memory.reprojector.shown_blocks()));
    EXPECT_EQ(canvas.painted, 20 * 12) << "all blocks";
    elsewhere.show(pool, beside(), &canvas);
    EXPECT_TRUE(elsewhere.repainted.empty()) << "nothing has changed";
    Screen other;
    other.show(pool, beside(), &canvas);
    canvas.painted = 0;
    elsewhere.show(pool, beside(), &canvas);
    EXPECT_EQ(canvas.painted, 20 * 12) << "the canvas has another's picture";
}

TEST(BlockCanvas, WhatIsInItsPlaceStaysInMemory) {
    FrameletPool const pool = filled(room(), front(), 0);
    FakeCanvas canvas;
    Screen screen, expected;
    screen.show(pool, beside(), &canvas);
    ASSERT_TRUE(screen.reprojector.is_on_canvas());
    screen.show(pool, front(), &canvas);
    EXPECT_FALSE(screen.reprojector.is_on_canvas());
    expected.show(pool, front(), nullptr);
    EXPECT_EQ(screen.picture, expected.picture);
    ASSERT_EQ(screen.repainted.size(), 1u) << "all of it";
}

TEST(BlockCanvas, MemoryHasAllOfThePictureWhenItsTurnComes) {
    FrameletPool const pool = filled(room(), front(), 0);
    FakeCanvas canvas;
    Screen screen, expected;
    expected.show(pool, beside(), nullptr);
    screen.show(pool, beside(), &canvas);
    screen.show(pool, beside(), nullptr);
    EXPECT_FALSE(screen.reprojector.is_on_canvas());
    EXPECT_EQ(screen.picture, expected.picture);
    screen.show(pool, beside(), &canvas);
    EXPECT_EQ(canvas.painted, 20 * 12) << "nor had the canvas what was painted meanwhile";
}

TEST(BlockCanvas, AfterItHasFailedMemoryHasAllOfThePicture) {
    FrameletPool const pool = filled(room(), front(), 0);
    FakeCanvas canvas;
    Screen screen, expected;
    screen.show(pool, front(), nullptr);
    canvas.fails = true;
    EXPECT_THROW(screen.show(pool, beside(), &canvas), CanvasError);
    screen.show(pool, beside(), nullptr);
    expected.show(pool, beside(), nullptr);
    EXPECT_EQ(screen.picture, expected.picture);
    EXPECT_EQ(screen.reprojector.hole_share(), expected.reprojector.hole_share());
}

TEST(BlockCanvas, WhatShowedIsKnownOfBlocksThatAreNotPaintedAgain) {
    ImagePlane const plane(viewport);
    AnalyticScene const scene = room();
    FrameletPool pool(plane);
    std::vector<Tile> const tiles = visible_tiles(plane, plane.pixel_depth());
    for (std::uint64_t i = 0; i <= FrameletPool::untried_moments; ++i) { // cameras that differ a little
        Camera camera = front();
        camera.position.x += 0.01f * static_cast<float>(i);
        std::size_t const count = i == 0 ? tiles.size() : tiles.size() / 4;
        pool.insert(scene.batch(plane, i + 1, camera, 0, {tiles.begin(), tiles.begin() + static_cast<int>(count)}),
                    scene.motions);
    }
    ASSERT_TRUE(pool.is_tried(0));
    FakeCanvas canvas;
    Screen memory, elsewhere;
    for (Screen* const screen : {&memory, &elsewhere}) {
        BlockCanvas* const its_canvas = screen == &elsewhere ? &canvas : nullptr;
        screen->show(pool, beside(), its_canvas);
        screen->show(pool, beside(), its_canvas);
    }
    EXPECT_EQ(canvas.painted, 0);
    EXPECT_GT(canvas.asked, 0);
    std::vector<Tile> shown, expected;
    ASSERT_TRUE(elsewhere.reprojector.add_shown(0, shown));
    ASSERT_TRUE(memory.reprojector.add_shown(0, expected));
    EXPECT_EQ(shown, expected);
    EXPECT_FALSE(shown.empty());
}

} // namespace
} // namespace framelet
