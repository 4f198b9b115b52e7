// A scene that jumps: what was rendered before shows only where nothing else does.
#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

constexpr int dark = 40, bright = 200;

AnalyticScene lit_floor(int level) {
    auto const light = static_cast<float>(level);
    AnalyticScene scene;
    scene.quads.push_back({{-8, 0, -8}, {16, 0, 0}, {0, 0, 16}, plain(light, light, light)});
    return scene;
}

/// A floor that is bright and coarse at second 1, in the left half of the picture, dark and fine all over at second 0.
FrameletPool switched_on() {
    ImagePlane const plane(viewport);
    FrameletPool pool(plane);
    AnalyticScene const before = lit_floor(dark), after = lit_floor(bright);
    pool.insert(before.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth())), before.motions);
    std::vector<Tile> left = visible_tiles(plane, plane.pixel_depth() - 2);
    std::erase_if(left, [&](Tile tile) { return plane.tile_rect(tile).left >= viewport.width / 2; });
    Camera aside = front();
    aside.position.x += 0.01f; // another moment
    pool.insert(after.batch(plane, 2, aside, 1, left), after.motions);
    return pool;
}

struct Levels {
    int left, right;
    bool operator==(Levels const&) const = default;
};

Levels levels_at(Shown const& shown) {
    int const y = viewport.height - 20;
    return {shown.picture.row(y)[4 * 40], shown.picture.row(y)[4 * (viewport.width - 40)]};
}

TEST(SceneJump, WhatWasRenderedBeforeShowsOnlyWhereNothingElseDoes) {
    FrameletPool const pool = switched_on();
    BodyMotions motions;
    EXPECT_EQ(levels_at(show(pool, front(), 1, motions)), (Levels{dark, dark})) << "the finer ones show";
    motions.jump_at(1);
    EXPECT_EQ(levels_at(show(pool, front(), 0.9, motions)), (Levels{dark, dark})) << "it has not jumped yet";
    EXPECT_EQ(levels_at(show(pool, front(), 1, motions)), (Levels{bright, dark}));
    motions.jump_at(3); // a jump that is still to come
    EXPECT_EQ(levels_at(show(pool, front(), 1.1, motions)), (Levels{bright, dark}));
}

TEST(SceneJump, WhatWasRenderedOfLaterShowsOnlyWhereNothingElseDoes) {
    ImagePlane const plane(viewport);
    AnalyticScene const before = lit_floor(dark), after = lit_floor(bright);
    Camera aside = front();
    aside.position.x += 0.01f;
    FrameletPool pool(plane);
    pool.insert(after.batch(plane, 1, aside, 1, visible_tiles(plane, plane.pixel_depth())), after.motions);
    pool.insert(before.batch(plane, 2, front(), 0.4, visible_tiles(plane, plane.pixel_depth() - 2)), before.motions);
    aside.position.x += 0.01f; // where neither is in its place
    BodyMotions motions;
    EXPECT_EQ(levels_at(show(pool, aside, 0.4, motions)), (Levels{bright, bright})) << "the finer ones show";
    motions.jump_at(0.5);
    EXPECT_EQ(levels_at(show(pool, aside, 0.4, motions)), (Levels{dark, dark}));
    EXPECT_EQ(levels_at(show(pool, aside, 0.5, motions)), (Levels{bright, bright}));
}

TEST(SceneJump, APictureFollowsItThoughNothingElseChanges) {
    FrameletPool const pool = switched_on();
    BodyMotions motions;
    motions.jump_at(1);
    Reprojector reprojector;
    Shown shown;
    std::vector<PixelRect> repainted;
    for (SceneTime const time : {0.9, 1.0, 0.9}) {
        reprojector.show(pool, {}, front(), time, motions, shown.picture, repainted);
        EXPECT_EQ(levels_at(shown).left, time < 1 ? dark : bright) << time;
    }
}

} // namespace
} // namespace framelet
