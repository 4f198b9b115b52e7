#include "common/held/shown_times.h"

#include <gtest/gtest.h>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

Batch batch_at(ImagePlane const& plane, std::uint64_t number, SceneTime time, std::vector<Tile> const& tiles) {
    Batch batch = make_batch(plane, number, {});
    batch.scene_time = time;
    for (Tile const tile : tiles) {
        batch.framelets.push_back(constant_framelet(plane, tile, 100));
    }
    return batch;
}

TEST(ShownTimes, AreThoseOfTheNewestFrameletsOfAnySize) {
    ImagePlane const plane(Viewport{64, 48}); // 4 x 3 blocks
    FrameletCache cache(plane);
    int const depth = plane.pixel_depth();
    ShownTimes times;
    std::vector<PixelRect> changed;
    auto const insert = [&](Batch const& batch) {
        cache.insert(batch);
        cache.take_changed(changed);
        update_shown_times(cache, changed, times);
    };
    insert(batch_at(plane, 1, 0.5, {make_tile(depth, 3, 0)}));
    EXPECT_EQ(times, (ShownTimes{{}, {}, {}, 0.5, {}, {}, {}, {}, {}, {}, {}, {}}));
    insert(batch_at(plane, 2, 1, visible_tiles(plane, depth - 2)));
    EXPECT_EQ(times, ShownTimes(12, 1.0));
    insert(batch_at(plane, 3, 3, {make_tile(depth, 1, 1), make_tile(depth + 1, 0, 0)}));
    ShownTimes expected(12, 1.0);
    expected[5] = 3;
    expected[0] = 1.5; // a quarter of it is new
    EXPECT_EQ(times, expected);
    insert(batch_at(plane, 4, 4, visible_tiles(plane, depth - 1)));
    EXPECT_EQ(times, ShownTimes(12, 4.0));
}

} // namespace
} // namespace framelet
