#include "server/sampling/plan/adaptive_refresh.h"

#include <algorithm>
#include <cstdio>
#include <malloc.h>
#include <map>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "tests/sampling/refresh_pictures.h"
#include "tests/uniform_tiling.h"

namespace framelet {
namespace {

using namespace test;

bool is_all_finest(AdaptiveRefresh const& refresh) {
    RegionGrid const& regions = refresh.regions();
    return std::ranges::all_of(regions.visible(),
                               [&](std::uint32_t index) { return regions[index].level == finest_level; });
}

/// Seconds in which the whole picture can be rendered at the finest level.
double finest_seconds(SyntheticRefresh const& synthetic) {
    Viewport const viewport = synthetic.input.state.view.viewport;
    ImagePlane const plane(viewport);
    return static_cast<double>(uniform_tile_count(plane, plane.max_depth()) * framelet_samples) /
           synthetic.input.samples_per_second;
}

TEST(AdaptiveRefresh, AStillSceneCompletes) {
    for (auto* const shading : {flat, texture}) {
        for (Viewport const viewport : {Viewport{1, 1}, {17, 5}, small, {1040, 40}}) {
            SyntheticRefresh synthetic(viewport, shading);
            synthetic.running = false;
            double const seconds = synthetic.finish(60);
            std::printf("still %dx%d: %.2f s, the finest picture alone takes %.2f s\n", viewport.width, viewport.height,
                        seconds, finest_seconds(synthetic));
            EXPECT_LT(seconds, 60);
            EXPECT_TRUE(is_all_finest(synthetic.refresh));
            EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
            EXPECT_FALSE(synthetic.step());
        }
    }
}

/// The regions under patches, each as often as it is under one.
std::multiset<std::uint32_t> regions_of(RegionGrid const& grid, std::vector<Patch> const& patches) {
    std::multiset<std::uint32_t> regions;
    for (Patch const& patch : patches) {
        std::uint32_t const first = grid.first_under(patch.node);
        std::uint32_t const count = 1u << (2 * (grid.depth() - patch.node.depth()));
        for (std::uint32_t i = first; i < first + count; ++i) {
            regions.insert(i);
        }
    }
    return regions;
}

/// Patches that the last plan took are not learnt yet when the next one is made.
TEST(AdaptiveRefresh, WhatIsInFlightIsNotTakenAgain) {
    for (std::size_t const batch : {1u, 8u, 64u, 1024u}) {
        SyntheticRefresh synthetic(small, texture);
        synthetic.running = false;
        synthetic.input.batch_framelets = batch;
        std::multiset<std::uint32_t> in_flight;
        std::size_t plans = 0;
        for (bool goes_on = true; goes_on; ++plans) {
            goes_on = synthetic.step();
            auto const taken = regions_of(synthetic.refresh.regions(), synthetic.patches);
            for (std::uint32_t const index : taken) {
                ASSERT_EQ(in_flight.count(index), 0u) << "region " << index << ", plan " << plans;
            }
            in_flight = taken;
        }
        EXPECT_GT(plans, 10u);
        for (std::uint32_t const index : synthetic.refresh.regions().visible()) {
            EXPECT_LT(synthetic.refresh.regions()[index].taken.level, 0) << "nothing is in flight for ever";
        }
    }
}

/// The finest tiles that were sent until the picture was complete, and how often each.
std::map<Tile, int> finest_sent(bool pipelined, Viewport viewport, std::optional<Viewport> first) {
    SyntheticRefresh synthetic(first.value_or(viewport), texture);
    synthetic.running = false;
    synthetic.pipelined = pipelined;
    if (first) {
        synthetic.step();
        synthetic.input.state.view.viewport = viewport; // while the first batch is in flight
    }
    std::map<Tile, int> sent;
    while (synthetic.step()) {
        for (DisplayFramelet const& framelet : synthetic.sent) {
            sent[framelet.tile] += framelet.tile.depth() == ImagePlane(viewport).max_depth() ? 1 : 0;
        }
    }
    EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
    std::erase_if(sent, [](auto const& entry) { return entry.second == 0; });
    return sent;
}

TEST(AdaptiveRefresh, PipelinedConvergesToTheSame) {
    for (Viewport const viewport : {Viewport{17, 5}, {130, 70}}) {
        ImagePlane const plane(viewport);
        auto const serial = finest_sent(false, viewport, {});
        EXPECT_EQ(serial.size(), uniform_tile_count(plane, plane.max_depth()));
        EXPECT_EQ(finest_sent(true, viewport, {}), serial);
        EXPECT_EQ(finest_sent(true, viewport, Viewport{200, 30}), serial) << "another size meanwhile";
        EXPECT_EQ(finest_sent(true, viewport, Viewport{16, 16}), serial) << "another size meanwhile";
    }
}

/// A tile is rendered once in a moment and then more finely, but for patches of which a part was not rendered yet.
TEST(AdaptiveRefresh, AMomentIsHardlyEverRenderedTwice) {
    for (bool const pipelined : {true, false}) {
        SyntheticRefresh synthetic(small, moving_texture);
        synthetic.pipelined = pipelined;
        synthetic.moment_length = 0.1;
        std::map<Tile, double> rendered; // and of which moment last
        std::size_t tiles = 0, repeated = 0;
        synthetic.run(5, [&] {
            std::set<Tile> batch;
            for (Tile const tile : synthetic.tiles) {
                EXPECT_TRUE(batch.insert(tile).second) << "twice in a batch";
                double const moment = synthetic.input.moment->begun;
                auto const [entry, is_new] = rendered.try_emplace(tile, moment);
                repeated += is_new || entry->second < moment ? 0 : 1;
                entry->second = moment;
                ++tiles;
            }
        });
        EXPECT_GT(tiles, 1000u);
        EXPECT_LT(repeated, tiles / 20) << "of " << tiles;
        synthetic.stop();
        EXPECT_LT(synthetic.finish(30), 30);
        EXPECT_TRUE(is_all_finest(synthetic.refresh));
    }
}

/// Rays for samples in so many seconds, as a share of those that there was time for.
double busy_share(SyntheticRefresh& synthetic, double seconds) {
    std::size_t rays = 0;
    synthetic.run(seconds,
                  [&] { rays += synthetic.tiles.size() * static_cast<std::size_t>(synthetic.rays_per_sample); });
    return static_cast<double>(rays * framelet_samples) / (seconds * synthetic.input.samples_per_second);
}

TEST(AdaptiveRefresh, OfAMovingCameraTheViewerKeepsWhatDoesNotChange) {
    for (bool const pipelined : {true, false}) {
        SyntheticRefresh synthetic(small, texture);
        synthetic.pipelined = pipelined;
        synthetic.moment_length = 0.1;
        synthetic.camera_speed = 1e-4f;
        synthetic.input.samples_per_second *= 8; // the moments that a viewer holds have all of it
        synthetic.input.moves_samples = true;
        EXPECT_GT(busy_share(synthetic, 1), 0.05) << "a sample a pixel, of four rays where that shows";
        EXPECT_LT(busy_share(synthetic, 3), 0.02) << "its clock runs, and nothing changes";
        synthetic.stop();
        EXPECT_LT(synthetic.finish(30), 30);
        EXPECT_TRUE(is_all_finest(synthetic.refresh));
    }
}

TEST(AdaptiveRefresh, OfAMomentNoTileIsRenderedTwiceWithAsManyRays) {
    SyntheticRefresh synthetic(small, moving_texture);
    synthetic.moment_length = 0.1;
    synthetic.camera_speed = 1e-4f;
    synthetic.input.moves_samples = true;
    std::map<Tile, std::pair<double, int>> rendered; // of which moment last, with how many rays a sample
    std::size_t tiles = 0;
    synthetic.run(3, [&] {
        for (Tile const tile : synthetic.tiles) {
            std::pair const now(synthetic.input.moment->begun, synthetic.rays_per_sample);
            auto const [entry, is_new] = rendered.try_emplace(tile, now);
            EXPECT_TRUE(is_new || entry->second < now) << "but with more rays";
            entry->second = now;
            ++tiles;
        }
    });
    EXPECT_GT(tiles, 500u);
    synthetic.stop();
    EXPECT_LT(synthetic.finish(30), 30);
    EXPECT_TRUE(is_all_finest(synthetic.refresh));
}

/// What stood while the clock ran is known to the viewer; it has to be seen once more when the clock stops, but that
/// has to end.
TEST(AdaptiveRefresh, CompletesAfterTheClockStops) {
    for (auto* const shading : {flat, texture}) {
        SyntheticRefresh synthetic(small, shading);
        synthetic.run(6);
        synthetic.stop();
        EXPECT_LT(synthetic.finish(30), 30);
        EXPECT_TRUE(is_all_finest(synthetic.refresh));
        EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
    }
}

/// The camera is away for one batch, at any point of a cycle: what was rendered there has to be rendered again here.
TEST(AdaptiveRefresh, ACameraThatReturnsWithinACycleIsNotForgotten) {
    int strays = 0;
    for (int stray = 1; stray < 60; ++stray) {
        SyntheticRefresh synthetic({64, 64}, texture);
        synthetic.running = false;
        synthetic.input.samples_per_second = 1e6;
        synthetic.input.batch_framelets = 8;
        std::set<Tile> owed;
        for (int i = 0; i < 2000; ++i) {
            synthetic.input.state.view.camera.position.x = i == stray ? 0.01f : 0;
            if (!synthetic.step()) {
                break;
            }
            for (Tile const tile : synthetic.tiles) {
                if (i == stray && synthetic.patches.front().depth == ImagePlane({64, 64}).max_depth()) {
                    owed.insert(tile);
                } else {
                    owed.erase(tile);
                }
            }
            strays += i == stray && !owed.empty() ? 1 : 0;
        }
        EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state)) << stray;
        EXPECT_TRUE(owed.empty()) << "away at batch " << stray << ": " << owed.size() << " tiles";
    }
    EXPECT_GT(strays, 5);
}

TEST(AdaptiveRefresh, WhatIsUnchangedIsNotSentAgain) {
    for (bool const moves_samples : {false, true}) {
        for (std::size_t const batch : {8u, 1024u}) {
            SyntheticRefresh synthetic(small, half_dust);
            synthetic.running = false;
            synthetic.input.moves_samples = moves_samples;
            synthetic.input.batch_framelets = batch;
            ASSERT_LT(synthetic.finish(60), 60);
            for (int moment = 1; moment < 4; ++moment) { // the clock is set, and nothing has changed
                synthetic.stopped_at = moment;
                std::size_t sent = 0, rendered = 0;
                while (synthetic.step()) {
                    sent += synthetic.sent.size();
                    rendered += synthetic.tiles.size();
                }
                EXPECT_TRUE(synthetic.refresh.is_complete(synthetic.input.state));
                EXPECT_GT(rendered, 0u) << "it might have";
                EXPECT_EQ(sent, 0u);
            }
        }
    }
}

/// Probes that are wrong by chance are few.
TEST(AdaptiveRefresh, WhileAClockRunsHardlyAnythingIsSentOfWhatStands) {
    SyntheticRefresh synthetic(small, texture);
    synthetic.input.samples_per_second *= 8;
    synthetic.run(2);
    EXPECT_LT(busy_share(synthetic, 3), 0.02);
}

/// A viewer that moves its samples has moved away what it got before the camera went elsewhere.
TEST(AdaptiveRefresh, AfterACameraHasReturnedAViewerThatMovesSamplesIsSentAllOfThem) {
    for (bool const moves_samples : {true, false}) {
        SyntheticRefresh synthetic({64, 64}, texture);
        synthetic.running = false;
        synthetic.input.moves_samples = moves_samples;
        synthetic.input.batch_framelets = 8;
        auto& camera = synthetic.input.state.view.camera;
        ASSERT_LT(synthetic.finish(60), 60);
        camera.position.x = 0.01f;
        ASSERT_TRUE(synthetic.step()); // rendered there
        camera.position.x = 0;
        ASSERT_TRUE(synthetic.step()); // and learnt
        std::set<Tile> sent;
        while (synthetic.step()) {
            for (DisplayFramelet const& framelet : synthetic.sent) {
                sent.insert(framelet.tile);
            }
        }
        ImagePlane const plane({64, 64});
        std::size_t const all = uniform_tile_count(plane, plane.max_depth());
        std::size_t const finest = static_cast<std::size_t>(
            std::ranges::count(sent, plane.max_depth(), [](Tile tile) { return tile.depth(); }));
        if (moves_samples) {
            EXPECT_EQ(finest, all);
        } else {
            EXPECT_LT(finest, all / 2) << "it shows them where they were rendered";
        }
    }
}

/// A line a third of a pixel wide, between the samples of every level from one a pixel upwards but not of all of its
/// length: it is slanted.
TEST(AdaptiveRefresh, FindsAHairInWhatWasFlat) {
    for (bool const was_flat : {true, false}) {
        for (std::size_t const batch : {8u, 1024u}) {
            double const appears = 8;
            auto const hair = [](float x, float y) { return std::abs(x - 100.2f - 0.02f * y) < 0.17f; };
            SyntheticRefresh synthetic(small, [&](float x, float y, double time) {
                return time > appears && hair(x, y) ? 1.0f : was_flat ? 0.25f : 0.5f * texture(x, y, 0);
            });
            synthetic.input.batch_framelets = batch;
            double found = 1e9;
            synthetic.run(appears + 8, [&] {
                for (DisplayFramelet const& framelet : synthetic.sent) {
                    if (std::count(framelet.red.begin(), framelet.red.end(), 255) > 0) {
                        found = std::min(found, synthetic.input.now - appears);
                    }
                }
            });
            std::printf("hair, %s, batch %zu: after %.2f s\n", was_flat ? "flat" : "texture", batch, found);
            EXPECT_LT(found, 8);
        }
    }
}

TEST(AdaptiveRefresh, ACycleCostsWhatItMay) {
    for (auto* const shading : {texture, moving_texture}) {
        SyntheticRefresh synthetic(small, shading);
        double const samples = synthetic.input.samples_per_second * static_cast<double>(synthetic.input.cycle_seconds);
        synthetic.run(10, [&] {
            double largest = 0;
            double cost = 2 * static_cast<double>(synthetic.probes);
            for (Patch const& patch : synthetic.patches) {
                double const one = framelet_samples * std::ldexp(1.0, 2 * (patch.depth - patch.node.depth()));
                largest = std::max(largest, one);
                cost += one;
            }
            ASSERT_LE(cost, samples + largest) << "at " << synthetic.input.now;
        });
    }
}

TEST(AdaptiveRefresh, SettlesAfterAStep) {
    for (std::size_t const batch : {8u, 64u, 1024u}) {
        SyntheticRefresh synthetic(small, moving_texture);
        synthetic.input.samples_per_second = 8.0 * small.width * small.height;
        synthetic.input.batch_framelets = batch;
        synthetic.run(3);
        synthetic.stop();
        double const seconds = synthetic.finish(60);
        std::printf("step, batch %zu: complete after %.2f s = %.0f cycles; the finest picture alone takes %.2f s\n",
                    batch, seconds, seconds / static_cast<double>(synthetic.input.cycle_seconds),
                    finest_seconds(synthetic));
        EXPECT_LT(seconds, 1.5 * finest_seconds(synthetic));
        EXPECT_TRUE(is_all_finest(synthetic.refresh));
    }
}

TEST(AdaptiveRefresh, DoesNotGrow) {
    SyntheticRefresh synthetic(small, moving_texture);
    synthetic.input.batch_framelets = 64;
    auto const most_bytes = [&] { // what is held varies from moment to moment
        std::size_t most = 0;
        synthetic.run(20, [&] { most = std::max<std::size_t>(most, mallinfo2().uordblks); });
        return most;
    };
    synthetic.run(100);
    std::size_t const before = most_bytes();
    EXPECT_LE(most_bytes(), before + 65536);
}

} // namespace
} // namespace framelet
