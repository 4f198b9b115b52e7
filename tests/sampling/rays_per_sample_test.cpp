#include <algorithm>
#include <cmath>
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

/// With light by paths: breadth first, sent at 1, 4, 16, 32, 64 .. paths, until the error is small enough.
TEST(AdaptiveRefresh, PathsAreAddedUntilTheirErrorIsSmall) {
    constexpr int telling = 16;
    Completion const completion = completion_of_paths;
    ImagePlane const plane(small);
    auto const variance = [&](Tile tile) { // of one path: more and more to the right
        return 1e-5f * std::pow(1.05f, static_cast<float>(plane.tile_rect(tile).left));
    };
    SyntheticRefresh synthetic(small, half_dust);
    synthetic.running = false;
    synthetic.input.completion = completion;
    synthetic.input.limits.most_level = completion.finest;
    synthetic.input.limits.most_rays = single_ray;
    synthetic.input.batch_framelets = 64;
    synthetic.error_of_paths = [&](Tile tile, int paths) {
        return paths < telling ? INFINITY : variance(tile) / static_cast<float>(paths);
    };
    std::map<Tile, int> paths;
    int last = single_ray;
    while (synthetic.step()) {
        EXPECT_GE(synthetic.tiles.empty() ? last : synthetic.rays_per_sample, last) << "the fewest first";
        last = synthetic.tiles.empty() ? last : synthetic.rays_per_sample;
        for (Tile const tile : synthetic.tiles) {
            int const had = paths[tile];
            EXPECT_EQ(synthetic.rays_per_sample, had == 0 ? single_ray : next_rays(had)) << tile.code;
            paths[tile] = synthetic.rays_per_sample;
        }
    }
    EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
    int least = completion.most_rays, most = 0;
    for (Tile const tile : make_uniform_tiling(plane, plane.pixel_depth()).tiles) {
        int wanted = telling;
        while (wanted < completion.most_rays && variance(tile) / static_cast<float>(wanted) > completion.enough) {
            wanted *= 2;
        }
        EXPECT_EQ(paths[tile], wanted) << tile.code;
        least = std::min(least, wanted);
        most = std::max(most, wanted);
    }
    EXPECT_EQ(least, telling);
    EXPECT_EQ(most, completion.most_rays);
}

TEST(RaysPerSample, ViewersSeeEachPictureThatIsMuchBetter) {
    std::vector<int> shown;
    for (int paths = single_ray; paths <= completion_of_paths.most_rays; paths = next_rays(paths)) {
        if (are_shown(paths)) {
            shown.push_back(paths);
        }
        EXPECT_LE(new_rays(next_rays(paths)), most_rays_at_once);
        EXPECT_GE(new_rays(next_rays(paths)), next_rays(paths) - paths);
    }
    EXPECT_EQ(shown, (std::vector{1, 4, 16, 32, 64, 128, 256, 512, 1024}));
}

} // namespace
} // namespace framelet
