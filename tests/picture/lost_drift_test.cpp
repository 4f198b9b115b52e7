// Something that bends, shown later than anybody knows where it has gone.
#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

/// A wall across the picture, so far before the floor's middle, all of it bending.
Batch bending_wall(std::uint64_t number, SceneTime time, double z, float luma) {
    AnalyticScene scene;
    scene.quads.push_back({{-8, -8, z}, {16, 0, 0}, {0, 16, 0}, plain(luma, luma, luma)});
    ImagePlane const plane(viewport);
    Batch batch = scene.batch(plane, number, front(), time, visible_tiles(plane, plane.pixel_depth()));
    for (FrameletShape& shape : batch.shapes) {
        for (std::size_t k = 0; k < shape.layer_count; ++k) {
            shape.layers[k].body = 7;
            shape.layers[k].drift.corner = {Vec3(4, 0, 0), Vec3(0), 1e4f};
        }
    }
    return batch;
}

TEST(LostDrift, ShowsWhereItWasRendered) {
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(bending_wall(1, 0, 0, 200), {});
    EXPECT_GT(show(pool, front(), 0.02).hole_share, 0) << "it has left an edge of the picture";
    Shown const later = show(pool, front(), 1);
    EXPECT_EQ(later.hole_share, 0);
    EXPECT_EQ(later.picture.row(viewport.height / 2)[4 * 2], 200);
}

TEST(LostDrift, HidesNothingThatCameSince) {
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(bending_wall(1, 0, 2, 40), {}); // which is the nearer one
    pool.insert(bending_wall(2, 1, 0, 200), {});
    Shown const shown = show(pool, front(), 1);
    int wrong = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            wrong += std::abs(shown.picture.row(y)[4 * x] - 200) > 1 ? 1 : 0;
        }
    }
    EXPECT_EQ(wrong, 0);
}

} // namespace
} // namespace framelet
