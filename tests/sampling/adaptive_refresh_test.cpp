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
    RegionField const& field = refresh.field();
    return std::all_of(field.visible().begin(), field.visible().end(),
                       [&](std::uint32_t index) { return field[index].level == sampling_levels - 1; });
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
std::multiset<std::uint32_t> regions_of(RegionField const& field, std::vector<Patch> const& patches) {
    std::multiset<std::uint32_t> regions;
    for (Patch const& patch : patches) {
        RegionField::Range const range = field.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
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
            auto const taken = regions_of(synthetic.refresh.field(), synthetic.patches);
            for (std::uint32_t const index : taken) {
                ASSERT_EQ(in_flight.count(index), 0u) << "region " << index << ", plan " << plans;
            }
            in_flight = taken;
        }
        EXPECT_GT(plans, 10u);
        for (std::uint32_t const index : synthetic.refresh.field().visible()) {
            EXPECT_LT(synthetic.refresh.field()[index].taken.level, 0) << "nothing is in flight for ever";
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
        synthetic.input.limits.periodic_share = 0;
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
    BodyMotions const motions;
    for (bool const pipelined : {true, false}) {
        SyntheticRefresh synthetic(small, texture);
        synthetic.pipelined = pipelined;
        synthetic.moment_length = 0.1;
        synthetic.camera_speed = 1e-4f;
        synthetic.input.samples_per_second *= 8; // the moments that a viewer holds have all of it
        synthetic.input.motions = &motions;
        EXPECT_GT(busy_share(synthetic, 1), 0.05) << "a sample a pixel, of four rays where that shows";
        EXPECT_LT(busy_share(synthetic, 3), 0.02) << "its clock runs, and nothing changes";
        synthetic.stop();
        EXPECT_LT(synthetic.finish(30), 30);
        EXPECT_TRUE(is_all_finest(synthetic.refresh));
    }
}

TEST(AdaptiveRefresh, OfAMomentNoTileIsRenderedTwiceWithAsManyRays) {
    BodyMotions const motions;
    SyntheticRefresh synthetic(small, moving_texture);
    synthetic.moment_length = 0.1;
    synthetic.camera_speed = 1e-4f;
    synthetic.input.motions = &motions;
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

TEST(AdaptiveRefresh, PeriodicRefreshesAndRefinementsAreNotOfTheSameTiles) {
    SyntheticRefresh synthetic(small, moving_texture);
    synthetic.moment_length = 0.1;
    synthetic.input.limits.periodic_share = 0.3;
    synthetic.run(5, [&] {
        std::set<Tile> batch;
        for (Tile const tile : synthetic.tiles) {
            EXPECT_TRUE(batch.insert(tile).second);
        }
    });
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
    for (bool const running : {false, true}) {
        for (std::size_t const batch : {8u, 1024u}) {
            SyntheticRefresh synthetic(small, texture);
            synthetic.running = running;
            synthetic.input.batch_framelets = batch;
            std::map<Tile, int> times;
            std::size_t late = 0;
            double const end = 20;
            synthetic.run(end, [&] {
                for (DisplayFramelet const& framelet : synthetic.sent) {
                    ++times[framelet.tile];
                }
                late += synthetic.input.now > 0.75 * end ? synthetic.sent.size() : 0;
            });
            int most = 0;
            for (auto const& [tile, count] : times) {
                most = std::max(most, count);
            }
            std::printf("unchanged, clock %s, batch %zu: a tile is sent at most %d times, %zu late\n",
                        running ? "runs" : "stands", batch, most, late);
            EXPECT_LE(most, running ? 2 : 1);
            EXPECT_EQ(late, 0u);
        }
    }
}

/// A viewer that moves its samples has moved away what it got before the camera went elsewhere.
TEST(AdaptiveRefresh, AfterACameraHasReturnedAViewerThatMovesSamplesIsSentAllOfThem) {
    BodyMotions const motions;
    for (bool const moves_samples : {true, false}) {
        SyntheticRefresh synthetic({64, 64}, texture);
        synthetic.running = false;
        synthetic.input.motions = moves_samples ? &motions : nullptr;
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
            double period = 0;
            synthetic.run(appears + 8, [&] {
                Budget const budget{synthetic.input.samples_per_second, synthetic.input.cycle_seconds, 0, 0};
                period = refresh_period(synthetic.refresh.field(), budget);
                for (DisplayFramelet const& framelet : synthetic.sent) {
                    if (std::count(framelet.red.begin(), framelet.red.end(), 255) > 0) {
                        found = std::min(found, synthetic.input.now - appears);
                    }
                }
            });
            std::printf("hair, %s, batch %zu: after %.2f s of %.2f\n", was_flat ? "flat" : "texture", batch, found,
                        period);
            EXPECT_LT(found, period + 0.1);
        }
    }
}

TEST(AdaptiveRefresh, EveryRegionIsRefreshed) {
    for (double const pictures_a_second : {1.0, 4.0, 30.0}) {
        for (std::size_t const batch : {8u, 64u, 1024u}) {
            SyntheticRefresh synthetic({256, 100}, moving_texture);
            synthetic.input.samples_per_second = pictures_a_second * 256 * 100;
            synthetic.input.batch_framelets = batch;
            double oldest = 0;
            Budget const budget{synthetic.input.samples_per_second, synthetic.input.cycle_seconds, 0, 0};
            RegionField const whole{ImagePlane({256, 100})};
            double const period = refresh_period(whole, budget);
            synthetic.run(3 * period, [&] {
                RegionField const& field = synthetic.refresh.field();
                for (std::uint32_t const index : field.visible()) {
                    double const refreshed = std::max(field[index].refreshed, 0.0);
                    oldest = std::max(oldest, synthetic.input.now - refreshed);
                }
            });
            std::printf("periodic refreshes, %.0f pictures/s, batch %zu: oldest %.2f s, period %.2f\n",
                        pictures_a_second, batch, oldest, period);
            EXPECT_LT(oldest, 2 * period);
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

/// Steady motion: how much of the tiling changes from cycle to cycle, and how far the price does.
TEST(AdaptiveRefresh, SettlesOnSteadyMotion) {
    SyntheticRefresh synthetic(small, [](float x, float y, double time) {
        return x < 100 ? moving_texture(x, y, time) : texture(x, y, 0); // both kinds
    });
    synthetic.input.samples_per_second = 8.0 * small.width * small.height;
    synthetic.run(10);
    std::vector<Patch> last;
    double changed = 0;
    int cycles = 0;
    float least = 1e9f;
    float most = 0;
    TilingScratch scratch;
    synthetic.run(4, [&] {
        RegionField const& field = synthetic.refresh.field();
        std::vector<float> density(field.size());
        for (std::uint32_t const index : field.visible()) {
            density[index] = samples_per_pixel(synthetic.refresh.choices()[index].level);
        }
        std::vector<Patch> cut;
        make_density_patches(field.plane(), density, field.depth(), scratch, cut);
        if (!last.empty()) {
            auto const is_new = [&](Patch const& patch) {
                return std::find(last.begin(), last.end(), patch) == last.end();
            };
            changed +=
                static_cast<double>(std::count_if(cut.begin(), cut.end(), is_new)) / static_cast<double>(cut.size());
            ++cycles;
        }
        last = cut;
        least = std::min(least, synthetic.refresh.price());
        most = std::max(most, synthetic.refresh.price());
    });
    std::printf("steady motion: %.4f of the patches change a cycle, price %.3g .. %.3g\n", changed / cycles, least,
                most);
    EXPECT_LT(changed / cycles, 0.1);
    EXPECT_LT(most / least, 10);
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
    synthetic.run(40); // until the largest batch has been seen
    std::size_t const before = mallinfo2().uordblks;
    synthetic.run(10);
    EXPECT_LE(mallinfo2().uordblks, before + 16384);
}

} // namespace
} // namespace framelet
