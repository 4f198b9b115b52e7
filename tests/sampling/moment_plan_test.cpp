#include "server/sampling/plan/moment/moment_plan.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "server/sampling/mirror/mirror_checks.h"
#include "tests/sampling/rendered_planes.h"

namespace framelet {
namespace {

constexpr Viewport viewport{250, 130};
ImagePlane const plane{viewport};
BodyMotions const no_motions;

MirrorView view_at(float x) {
    Camera camera;
    camera.position.x = x;
    return {make_view_rays(camera, viewport), 0};
}
/// A picture whose left half is flat and whose right half is not.
Seen half_busy(float x, float y) {
    float const wave = 0.5f + 0.2f * std::sin(1.7f * x) * std::sin(1.3f * y);
    return {10, x < 128 ? 0.5f : wave};
}

struct Planner {
    Mirror mirror{viewport};
    RegionGrid regions{plane};
    MomentPlan plan;
    std::vector<RatedPatch> rated;

    double find(double samples) { return find(MomentBudget{samples, {}, 0, 0}); }
    double find(MomentBudget const& budget) {
        plan.find(mirror, regions, budget, rated);
        double cost = 0;
        for (RatedPatch const& entry : rated) {
            cost += entry.cost;
            EXPECT_TRUE(std::isfinite(entry.urgency) && entry.urgency > 0);
        }
        return cost;
    }
    std::vector<Tile> tiles() const {
        std::vector<Tile> tiles;
        for (RatedPatch const& entry : rated) {
            append_tiles(plane, entry.patch, tiles);
        }
        return tiles;
    }
    void render(MirrorView const& view, Look const& look) {
        std::vector<Piece> pieces;
        std::vector<Tile> tiles;
        for (RatedPatch const& entry : rated) {
            tiles.clear();
            append_tiles(plane, entry.patch, tiles);
            for (Tile const tile : tiles) {
                RenderedTile one = render_tile(plane, tile, look);
                one.rendered.is_supersampled = entry.rays_per_sample == four_rays;
                cut_pieces(one, plane, 0, pieces);
            }
        }
        mirror.add(view.rays, no_motions, pieces);
    }
};

TEST(MomentPlan, UsesItsBudgetAndCoversWhatIsEmpty) {
    for (double const share : {0.1, 0.2, 0.5, 1.0, 3.0}) {
        Planner planner;
        double const samples = share * viewport.width * viewport.height;
        planner.mirror.look(view_at(0), no_motions);
        double const cost = planner.find(samples);
        EXPECT_LE(cost, samples) << share;
        EXPECT_GT(cost, 0.2 * samples) << share; // all regions alike: a level more of one is one more of all
        std::set<std::uint32_t> pixels;
        for (Tile const tile : planner.tiles()) {
            PixelRect const rect = plane.tile_rect(tile);
            for (int y = rect.top; y < std::min(rect.bottom, viewport.height); ++y) {
                for (int x = rect.left; x < std::min(rect.right, viewport.width); ++x) {
                    EXPECT_TRUE(pixels.insert(static_cast<std::uint32_t>(y * viewport.width + x)).second) << "twice";
                }
            }
        }
        EXPECT_EQ(pixels.size(), static_cast<std::size_t>(viewport.width * viewport.height));
    }
}

TEST(MomentPlan, WhatHasNotChangedIsRatedAsItWas) {
    Planner planner;
    std::minstd_rand random(1);
    MirrorView view = view_at(0);
    planner.mirror.look(view, no_motions);
    planner.mirror.add(view.rays, no_motions, render_pieces(plane, plane.pixel_depth() - 2, half_busy));
    for (int step = 0; step < 60; ++step) {
        if (step % 15 == 14) {
            view.scene_time += 0.1;
            planner.mirror.look(view, no_motions);
        }
        if (step % 3 == 1) {
            CellFault const fault{{static_cast<float>(random() % 250), static_cast<float>(random() % 130)}, 16, true};
            planner.mirror.mark(std::span(&fault, 1));
        }
        MomentBudget budget{0.05 * viewport.width * viewport.height, {}, 0, 0};
        budget.rests = true; // the picture's mean detail, which is kept for longer, counts for nothing
        budget.bias = step < 30 ? 0 : 0.5f;
        planner.find(budget);
        auto const rated = planner.rated;
        MomentPlan().find(planner.mirror, planner.regions, budget, planner.rated);
        ASSERT_EQ(rated.size(), planner.rated.size()) << step;
        for (std::size_t i = 0; i < rated.size(); ++i) {
            EXPECT_EQ(rated[i].patch.node.code, planner.rated[i].patch.node.code) << step;
            EXPECT_EQ(rated[i].patch.depth, planner.rated[i].patch.depth) << step;
            EXPECT_EQ(rated[i].urgency, planner.rated[i].urgency) << step;
        }
        if (!rated.empty() && step % 4 == 2) { // some is taken, which is rendered later, or never
            planner.regions.take(rated.front().patch, step, single_ray);
        }
        planner.render(view, half_busy);
    }
}

TEST(MomentPlan, TheBusyHalfGetsTheFinerSamples) {
    Planner planner;
    planner.mirror.look(view_at(0), no_motions);
    planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, half_busy));
    planner.find(0.2 * viewport.width * viewport.height);
    EXPECT_FALSE(planner.rated.empty());
    for (Tile const tile : planner.tiles()) {
        EXPECT_GE(plane.tile_rect(tile).left, 128);
        EXPECT_GE(tile.depth(), plane.pixel_depth());
    }
}

TEST(MomentPlan, FaintDetailGetsSamplesBesideWhatIsBusy) {
    auto const look = [](float x, float y) {
        float const contrast = x < 128 ? 0.02f : 0.2f;
        return Seen{10, 0.5f + contrast * std::sin(1.7f * x) * std::sin(1.3f * y)};
    };
    Planner planner;
    planner.mirror.look(view_at(0), no_motions);
    planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, look));
    planner.find(4 * viewport.width * viewport.height);
    double faint = 0, busy = 0;
    for (Tile const tile : planner.tiles()) {
        (plane.tile_rect(tile).left < 128 ? faint : busy) += framelet_samples;
    }
    EXPECT_GT(faint, 0.3 * busy);
}

TEST(MomentPlan, WhatHasChangedIsRenderedCoarselyFirst) {
    Planner planner;
    constexpr double samples = viewport.width * viewport.height;
    planner.mirror.look(view_at(0), no_motions);
    planner.find(samples);
    planner.render(view_at(0), half_busy);
    MirrorView later = view_at(0);
    later.scene_time = 1;
    planner.mirror.look(later, no_motions);
    double const refined = planner.find(samples);
    std::vector<Probe> probes;
    list_probes(planner.mirror, cell_grid(cell_side, 16, 0), false, probes);
    planner.mirror.mark(
        find_stale(planner.mirror, probes, {std::vector<float>(probes.size(), 0.0f)}, 16)); // the light is out
    for (float const bias : {-1.0f, 1.0f}) { // how much of the error is stale is no matter of wishes
        EXPECT_LT(planner.find(MomentBudget{samples, {}, {}, 0, 0.25 * samples, 1, bias}), 0.5 * samples) << bias;
    }
    double const cost = planner.find(MomentBudget{samples, {}, {}, 0, 0.25 * samples});
    EXPECT_GT(cost, 0);
    EXPECT_LT(cost, 0.3 * samples) << refined;
    std::size_t pixels = 0;
    for (Tile const tile : planner.tiles()) {
        PixelRect const rect = plane.tile_rect(tile);
        pixels += static_cast<std::size_t>(rect.width() * rect.height());
    }
    EXPECT_GT(static_cast<double>(pixels), 0.9 * samples) << "all of it";
    double const finely = planner.find(MomentBudget{samples, {.coarse_first = false}, {}, 0, 0.25 * samples});
    EXPECT_GT(finely, 2 * cost) << "unless that is not wished";
}

TEST(MomentPlan, NothingIsPlannedTwiceAndInTheEndNothing) {
    Planner planner;
    std::set<std::pair<Tile, int>> rendered; // and rays a sample
    std::vector<Tile> tiles;
    constexpr double share = 0.3;
    constexpr double most_rounds = 1.5 * (1 + 4 + 16) / share; // of every level all
    int rounds = 0;
    for (; rounds < most_rounds; ++rounds) {
        planner.mirror.look(view_at(0), no_motions);
        planner.find(share * viewport.width * viewport.height);
        if (planner.rated.empty()) {
            break;
        }
        for (RatedPatch const& entry : planner.rated) {
            tiles.clear();
            append_tiles(plane, entry.patch, tiles);
            for (Tile const tile : tiles) {
                EXPECT_TRUE(rendered.insert({tile, entry.rays_per_sample}).second);
                EXPECT_NE(plane.max_depth() - tile.depth(), 1) << "half a pixel apart: means say as much";
            }
        }
        planner.render(view_at(0), half_busy);
    }
    EXPECT_GT(rounds, 3);
    EXPECT_LT(rounds, most_rounds);
}

TEST(MomentPlan, WhatStandsIsRefinedToTheFinestSamplesAndWhatMovesIsNot) {
    constexpr double samples = 100.0 * viewport.width * viewport.height;
    std::vector<Piece> const fine = render_pieces(plane, plane.pixel_depth() + 1, half_busy);
    auto const deepest_after = [&](auto change, float x) {
        Planner planner;
        std::vector<Piece> pieces = fine;
        for (Piece& piece : pieces) {
            change(piece);
        }
        planner.mirror.add(view_at(0).rays, no_motions, pieces);
        planner.mirror.look(view_at(x), no_motions);
        planner.find(samples);
        int deepest = 0;
        for (Tile const tile : planner.tiles()) {
            EXPECT_GE(plane.tile_rect(tile).left, x > 0 ? 0 : 120) << "the other half is flat";
            deepest = std::max(deepest, tile.depth());
        }
        return deepest;
    };
    EXPECT_EQ(deepest_after([](Piece&) {}, 0), plane.max_depth());
    EXPECT_EQ(deepest_after([](Piece& piece) { piece.moves = true; }, 0), 0);
    EXPECT_EQ(deepest_after([](Piece& piece) { piece.decorrelation = 1; }, 0), plane.max_depth())
        << "what has not moved does not wear";
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    EXPECT_LT(deepest_after([](Piece&) {}, 20 * pixel), plane.max_depth());
}

/// The viewer would go on showing what is finer.
TEST(MomentPlan, WhatIsStaleIsRenderedAsFineAsWhatItHasToReplace) {
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    Planner planner;
    planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), half_busy));
    MirrorView later = view_at(-pixel); // nearly all is in view still, moved
    later.scene_time = 1;
    planner.mirror.look(later, no_motions);
    ASSERT_FALSE(planner.mirror.gives_way(planner.mirror.cell(20, 10)));
    std::vector<Probe> probes;
    list_probes(planner.mirror, cell_grid(cell_side, 16, 0), false, probes);
    planner.mirror.mark(find_stale(planner.mirror, probes, {std::vector<float>(probes.size(), 0.0f)}, 16));
    ASSERT_GT(planner.mirror.cell(20, 10).stale, 0);
    planner.find(0.25 * viewport.width * viewport.height);
    int inside = 0;
    for (Tile const tile : planner.tiles()) {
        PixelRect const rect = plane.tile_rect(tile);
        if (rect.left >= 16 && rect.right <= 224) {
            EXPECT_GE(tile.depth(), plane.pixel_depth());
            ++inside;
        }
    }
    EXPECT_GT(inside, 5);
}

TEST(MomentPlan, SamplesThatAreLeftOverBecomeMeansOfFourRays) {
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    auto const planned = [&](double samples, bool supersampled) {
        Planner planner;
        std::vector<Piece> pieces = render_pieces(plane, plane.pixel_depth(), half_busy);
        std::ranges::for_each(pieces, [&](Piece& piece) { piece.is_supersampled = supersampled; });
        planner.mirror.add(view_at(0).rays, no_motions, pieces);
        planner.mirror.look(view_at(-pixel), no_motions); // nearly all is in view still, moved
        planner.find(samples);
        double rays = 0;
        for (RatedPatch const& entry : planner.rated) {
            EXPECT_LE(entry.patch.depth, plane.pixel_depth());
            EXPECT_EQ(entry.samples, framelet_samples * tile_count(entry.patch) * entry.rays_per_sample);
            rays += entry.rays_per_sample == four_rays ? entry.samples : 0;
        }
        return rays;
    };
    constexpr double pixels = viewport.width * viewport.height;
    EXPECT_LE(planned(0.02 * pixels, false), four_rays * framelet_samples)
        << "what comes into view is first, but for a tile where rounding decides";
    EXPECT_GT(planned(4 * pixels, false), pixels) << "half of them are of detail";
    EXPECT_LT(planned(4 * pixels, true), 0.5 * pixels) << "they are held";
}

/// A link that is scarce by a little leaves hardly a ray over: what it carries would not be rendered at all.
TEST(MomentPlan, RaysAreAsCheapAsTheLinkLeavesTimeForThem) {
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    constexpr double samples = viewport.width * viewport.height;
    constexpr double beyond_edges = 256.0 * 160 / samples; // tiles of 32 pixels reach over them, and cost nothing there
    double before = -1;
    for (float const rays : {1.0f, 1.1f, 2.0f, 4.0f, 100.0f}) {
        Planner planner;
        planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), half_busy));
        planner.mirror.look(view_at(-pixel), no_motions);
        planner.plan.find(planner.mirror, planner.regions, {samples, {}, 0, 0, 0, rays}, planner.rated);
        double traced = 0, supersampled = 0;
        for (RatedPatch const& entry : planner.rated) {
            traced += entry.samples;
            supersampled += entry.rays_per_sample == four_rays ? entry.samples / four_rays : 0;
        }
        EXPECT_LE(traced, rays * beyond_edges * samples) << rays;
        EXPECT_GE(supersampled, before) << rays;
        before = supersampled;
    }
    EXPECT_GT(before, 0);
}

/// Of a picture of which one half has changed and the other one is coarse.
TEST(MomentPlan, TheBiasChoosesBetweenWhatIsOldAndWhatIsCoarse) {
    constexpr int middle = 128;
    auto const busy = [](float x, float y) { return Seen{10, 0.5f + 0.2f * std::sin(1.7f * x) * std::sin(1.3f * y)}; };
    std::vector<CellFault> changed;
    for (int y = cell_side / 2; y < viewport.height; y += cell_side) {
        for (int x = cell_side / 2; x < middle; x += cell_side) {
            changed.push_back({Vec2(x, y), cell_side, false, 0.01f});
        }
    }
    std::vector<double> shares, coarseness; // of the samples: in what has changed; mean levels up from the finest
    for (float const bias : {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f}) {
        Planner planner;
        planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth() - 1, busy));
        planner.mirror.look(view_at(0), no_motions);
        planner.mirror.mark(changed);
        double const samples = 0.5 * viewport.width * viewport.height;
        double const all = planner.find(MomentBudget{samples, {}, 0, 0, 0, 1, bias});
        double in_changed = 0, levels = 0;
        for (RatedPatch const& entry : planner.rated) {
            in_changed += plane.tile_rect(entry.patch.node).left < middle ? entry.cost : 0;
            levels += entry.cost * (plane.max_depth() - entry.patch.depth);
        }
        ASSERT_GT(all, 0) << bias;
        shares.push_back(in_changed / all);
        coarseness.push_back(levels / all);
    }
    EXPECT_TRUE(std::ranges::is_sorted(shares)) << testing::PrintToString(shares);
    EXPECT_TRUE(std::ranges::is_sorted(coarseness)) << testing::PrintToString(coarseness);
    EXPECT_GT(shares.back(), shares.front() + 0.2);
}

TEST(MomentPlan, WhatComesIntoViewIsFirst) {
    Planner planner;
    planner.mirror.look(view_at(0), no_motions);
    planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), half_busy));
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    planner.mirror.look(view_at(20 * pixel), no_motions);
    planner.find(viewport.width * viewport.height);
    double const samples = 20.0 * viewport.height; // what the strip takes
    select_most_urgent(samples, samples, planner.rated);
    ASSERT_FALSE(planner.rated.empty());
    for (Tile const tile : planner.tiles()) {
        EXPECT_GT(plane.tile_rect(tile).right, viewport.width - 20);
    }
}

/// Of what another camera saw nothing finer than a pixel is worth its samples, as long as it will be moved on.
TEST(MomentPlan, OfWhatStandsDetailGetsFinerSamplesThanPixels) {
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    for (bool const rests : {false, true}) {
        Planner planner;
        planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), half_busy));
        planner.mirror.look(view_at(pixel), no_motions);
        planner.find(MomentBudget{20.0 * viewport.width * viewport.height, {}, 0, 0, 0, 1, 0, rests});
        std::size_t finer = 0;
        for (Tile const tile : planner.tiles()) {
            if (tile.depth() > plane.pixel_depth()) {
                ++finer;
                EXPECT_GT(plane.tile_rect(tile).right, 112) << "short of the edge it is as good as it gets";
            }
        }
        EXPECT_EQ(finer > 0, rests);
    }
}

/// What the viewer has moved to a picture that stands is rendered again before what it did not move.
TEST(MomentPlan, WhatWasMovedIsDoubtedOnceAllStands) {
    float const pixel = 10 * view_at(0).rays.direction_dx.x;
    auto const flat = [](float, float) { return Seen{}; };
    for (bool const moved : {false, true}) {
        Planner planner;
        planner.mirror.add(view_at(0).rays, no_motions, render_pieces(plane, plane.pixel_depth(), flat));
        planner.mirror.look(view_at(moved ? pixel / 100 : 0), no_motions);
        planner.find(MomentBudget{20.0 * viewport.width * viewport.height, {}, 0, 0, 0, 1, 0, true});
        EXPECT_EQ(planner.rated.empty(), !moved);
    }
}

TEST(MomentPlan, WhatIsTakenIsNotTakenAgain) {
    Planner planner;
    planner.mirror.look(view_at(0), no_motions);
    for (std::uint32_t const index : planner.regions.visible()) {
        planner.regions[index].taken = {finest_level, 0};
    }
    planner.find(1e6);
    EXPECT_TRUE(planner.rated.empty());
}

} // namespace
} // namespace framelet
