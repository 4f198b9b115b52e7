#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "tests/sampling/refresh_pictures.h"
#include "tests/uniform_tiling.h"

namespace framelet {
namespace {

using namespace test;

/// Each region gets them once, where they are needed; then there is nothing to do.
TEST(AdaptiveRefresh, WhatTheFinestSamplesDoNotResolveGetsFourRaysASample) {
    SyntheticRefresh synthetic(small, half_dust);
    synthetic.running = false;
    for (float const camera : {0.0f, 1.0f}) { // and the same again from elsewhere
        synthetic.input.state.view.camera.position.x = camera;
        std::map<Tile, int> times;
        int last_rays = single_ray;
        bool in_order = true;
        while (synthetic.step()) {
            for (Tile const tile : synthetic.tiles) {
                times[tile] += synthetic.rays_per_sample == four_rays ? 1 : 0;
            }
            in_order = in_order && (synthetic.tiles.empty() || synthetic.rays_per_sample >= last_rays);
            last_rays = synthetic.tiles.empty() ? last_rays : synthetic.rays_per_sample;
        }
        EXPECT_TRUE(in_order) << "single rays first, everywhere";
        EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
        ImagePlane const plane(small);
        for (Tile const tile : make_uniform_tiling(plane, plane.max_depth()).tiles) {
            EXPECT_EQ(times[tile], plane.tile_rect(tile).left < 128 ? 0 : 1) << tile.code;
        }
    }
}

TEST(AdaptiveRefresh, WhileAnythingMovesFourRaysAreForWhatTheViewerMoves) {
    auto const most_rays = [&](double samples_per_second, int limit) {
        SyntheticRefresh synthetic(small, half_dust);
        synthetic.input.limits.most_rays = limit;
        synthetic.moment_length = 0.1;
        synthetic.camera_speed = 1e-4f;
        synthetic.input.moves_samples = true;
        synthetic.input.samples_per_second = samples_per_second;
        int most = single_ray;
        synthetic.run(2, [&] { most = std::max(most, synthetic.rays_per_sample); });
        return most;
    };
    EXPECT_EQ(most_rays(5e3, four_rays), single_ray) << "a sample a pixel comes first";
    EXPECT_EQ(most_rays(4e6, four_rays), four_rays);
    EXPECT_EQ(most_rays(4e6, single_ray), single_ray);
}

/// A batch of four rays a sample that was planned is not gone on with once the camera moves.
TEST(AdaptiveRefresh, MotionEndsFourRaysASample) {
    SyntheticRefresh synthetic(small, half_dust);
    synthetic.running = false;
    synthetic.input.batch_framelets = 8;
    while (synthetic.rays_per_sample == single_ray && synthetic.step()) {
    }
    ASSERT_EQ(synthetic.rays_per_sample, four_rays);
    synthetic.input.state.view.camera.position.x = 1;
    synthetic.step();
    EXPECT_EQ(synthetic.rays_per_sample, single_ray);
}

} // namespace
} // namespace framelet
