#include "common/warp/warp_block.h"

#include <gtest/gtest.h>

#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

/// Boards at many places between the samples, seen from the side, cover as many pixels as rays hit, on the average.
/// What lies behind is held from two cameras, so that it shows beside the boards, which are held from one or from
/// several.
TEST(WarpBlock, WhatCoversIsAsWideAsItIs) {
    Camera const display = look_at(Vec3(0.1f, 1.5f, 5.9f), Vec3(0.05f, 1, 0), Vec3(0, 1, 0), 0.8f);
    ImagePlane const plane(viewport);
    ViewRays const rays = make_view_rays(display, viewport);
    for (int levels = -2; levels <= 0; ++levels) {
        for (int const moments : {1, 4}) {
            int expected = 0, found = 0;
            for (int trial = 0; trial < 16; ++trial) {
                AnalyticScene scene;
                scene.quads.push_back({{-16, -8, -3}, {32, 0, 0}, {0, 16, 0}, waves(12, 6)});
                FrameletPool pool(plane);
                Camera const aside = look_at(Vec3(0.8f, 1.5f, 6), Vec3(0.8f, 1, 0), Vec3(0, 1, 0), 0.8f);
                pool.insert(scene.batch(plane, 1, aside, 0, visible_tiles(plane, plane.pixel_depth() + levels)),
                            scene.motions);
                for (int i = 0; i < 4; ++i) {
                    scene.quads.push_back(
                        {{-1.2 + 0.6 * i + 0.013 * trial, -1, 1}, {0.2, 0, 0}, {0.3, 4, 0}, waves(2, 2)});
                }
                for (int i = 0; i < moments; ++i) {
                    Camera camera = front();
                    camera.position.x += 0.1f * static_cast<float>(i);
                    pool.insert(scene.batch(plane, static_cast<std::uint64_t>(2 + i), camera, 0,
                                            visible_tiles(plane, plane.pixel_depth() + levels)),
                                scene.motions);
                }
                Shown const shown = show(pool, display, 0);
                std::vector<Quad> const placed = scene.at_time(0);
                for (int y = 40; y < viewport.height - 40; ++y) {
                    for (int x = 40; x < viewport.width - 40; ++x) {
                        expected += scene.cast(placed, rays, x + 0.5, y + 0.5).quad > 0 ? 1 : 0;
                        found += shown.inverse_depth[at(x, y)] > 0.16f ? 1 : 0;
                    }
                }
            }
            EXPECT_NEAR(found, expected, (moments == 1 ? 0.03 : 0.06) * expected) << levels << ' ' << moments;
        }
    }
}

} // namespace
} // namespace framelet
