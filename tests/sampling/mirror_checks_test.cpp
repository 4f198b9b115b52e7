#include "server/sampling/mirror/mirror_checks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sampling/mirror_views.h"

namespace framelet {
namespace {

using namespace test;

TEST(Mirror, SomethingNearerThanWhatShowsIsWrongUntilItComes) {
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall)); // at 10 metres
    RayGrid const grid = cell_grid(cell_side, 8, 1);
    std::size_t const columns = static_cast<std::size_t>(grid.columns(viewport));
    std::vector<float> seen(columns * static_cast<std::size_t>(grid.rows(viewport)), 0.1f);
    mirror.look(view_at(Vec3(1e-4f, 0, 0)), no_motions);
    EXPECT_FALSE(mirror.mark(find_wrong(mirror, grid, seen)));
    seen[5 * columns + 6] = -1; // not known
    seen[5 * columns + 7] = 0.05f; // farther
    seen[4 * columns + 4] = 0.11f; // hardly nearer
    EXPECT_FALSE(mirror.mark(find_wrong(mirror, grid, seen)));
    seen[3 * columns + 2] = 0.5f;
    EXPECT_TRUE(mirror.mark(find_wrong(mirror, grid, seen)));
    auto const wrong = [&] {
        return std::ranges::count_if(cells_of(mirror), [](Cell const& cell) { return cell.is_wrong; });
    };
    EXPECT_EQ(wrong(), 4) << "a square of the grid";
    mirror.add(view_at(Vec3(1e-4f, 0, 0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    EXPECT_EQ(wrong(), 0) << "that is what it looks like now";
}

TEST(Mirror, WhatLooksOtherwiseIsStaleUntilItComes) {
    MirrorView const later = view_at(Vec3(0), 1);
    RayGrid const grid = cell_grid(cell_side, 16, 0);
    auto const lamp = [](float x, float) { return Seen{10, x < 64 ? 0.9f : 0.5f}; };
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), wall));
    std::vector<Probe> probes;
    list_probes(mirror, grid, false, probes);
    EXPECT_TRUE(probes.empty()) << "what is of the moment needs none";
    mirror.look(later, no_motions);
    list_probes(mirror, grid, false, probes);
    ASSERT_EQ(probes.size(), std::size_t{viewport.width / 16 * (viewport.height / 16)});
    std::vector<float> luma;
    for (Probe const& probe : probes) {
        EXPECT_NEAR(probe.luma, 0.5f, 4e-3f);
        luma.push_back(probe.luma);
    }
    EXPECT_FALSE(mirror.mark(find_stale(mirror, probes, {luma}, grid.spacing)));
    for (std::size_t i = 0; i < probes.size(); ++i) {
        luma[i] = lamp(probes[i].position.x, probes[i].position.y).luma;
    }
    EXPECT_TRUE(mirror.mark(find_stale(mirror, probes, {luma}, grid.spacing)));
    for (int y = 0; y < viewport.height - 16; y += cell_side) {
        for (int x = 0; x < viewport.width; x += cell_side) {
            if (x < 48 || x >= 72) { // the squares of probes on both sides of the change
                EXPECT_NEAR(mirror.cell(x / cell_side, y / cell_side).stale, x < 64 ? 0.16f : 0, 4e-3f);
            }
        }
    }
    mirror.add(later.rays, no_motions, render_pieces(plane, plane.pixel_depth(), lamp, 2, 1));
    EXPECT_TRUE(std::ranges::all_of(cells_of(mirror), [](Cell const& cell) { return cell.stale == 0; }));
}

/// Of a wall so rough that its luma says nothing, at the same scene time.
TEST(Mirror, WhatWasLitByLessThanIsKnownNowIsStale) {
    auto const rough = [](float x, float y) {
        return Seen{10, std::fmod(x + 3 * y, 7.0f) < 3 ? 0.7f : 0.3f, static_body, 2.0f};
    };
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth(), rough));
    std::vector<Probe> probes;
    list_probes(mirror, cell_grid(cell_side, 16, 0), true, probes);
    ASSERT_EQ(probes.size(), std::size_t{viewport.width / 16 * (viewport.height / 16)});
    std::vector<float> luma;
    for (Probe const& probe : probes) {
        luma.push_back(rough(probe.position.x, probe.position.y).luma);
    }
    std::vector<SampleLight> light(probes.size(), {2.0f, 0.5f});
    EXPECT_FALSE(mirror.mark(find_stale(mirror, probes, {luma, light}, 16)));
    light.assign(probes.size(), {2.01f, 0.5f});
    EXPECT_FALSE(mirror.mark(find_stale(mirror, probes, {luma, light}, 16))) << "less than a display step";
    light.assign(probes.size(), {2.2f, 0.5f});
    std::vector<CellFault> const faults = find_stale(mirror, probes, {luma, light}, 16);
    EXPECT_EQ(faults.size(), probes.size());
    for (std::size_t i = 0; i < faults.size(); ++i) {
        float const change = luma[i] * 0.5f * (0.2f / 2.2f) / 2.2f; // of which half is of this light, and luma a root
        EXPECT_NEAR(faults[i].stale, change * change, 1e-6f);
    }
    std::vector<Probe> others;
    mirror.look(view_at(Vec3(0), 1), no_motions);
    list_probes(mirror, cell_grid(cell_side, 16, 0), false, others);
    ASSERT_EQ(others.size(), probes.size());
    luma.clear();
    for (Probe const& probe : others) {
        luma.push_back(rough(probe.position.x, probe.position.y).luma);
    }
    EXPECT_FALSE(mirror.mark(find_stale(mirror, others, {luma, light}, 16))) << "off the middle light may be another";
    light.assign(probes.size(), {0, 0});
    EXPECT_FALSE(mirror.mark(find_stale(mirror, probes, {luma, light}, 16))) << "where nothing is known";
}

TEST(Mirror, CellsThatPiecesShareAreProbedToo) {
    // Each of the finest framelets has two layers, whose pieces cover half a cell each.
    auto const steps = [](float, float y) { return Seen{std::fmod(y, 4.0f) < 2 ? 10.0f : 7.0f}; };
    Mirror mirror(viewport);
    mirror.look(view_at(Vec3(0)), no_motions);
    mirror.add(view_at(Vec3(0)).rays, no_motions, render_pieces(plane, plane.pixel_depth() + 2, steps));
    mirror.look(view_at(Vec3(0), 1), no_motions);
    std::vector<Probe> probes;
    list_probes(mirror, cell_grid(cell_side, 16, 0), false, probes);
    ASSERT_EQ(probes.size(), std::size_t{viewport.width / 16 * (viewport.height / 16)});
    std::vector<float> const dark(probes.size(), 0.1f);
    EXPECT_TRUE(mirror.mark(find_stale(mirror, probes, {dark}, 16)));
}

TEST(RayGrid, EveryCellHasItsTurn) {
    for (int const spacing : {4, 8, 16}) {
        std::set<std::pair<float, float>> firsts;
        auto const turns = static_cast<std::uint32_t>(spacing / 4 * (spacing / 4));
        for (std::uint32_t turn = 0; turn < turns; ++turn) {
            RayGrid const grid = cell_grid(4, spacing, turn);
            firsts.insert({grid.first.x, grid.first.y});
            EXPECT_LT(grid.first.x, static_cast<float>(spacing));
            EXPECT_GE(grid.columns({5, 5}) * grid.rows({5, 5}), grid.first.x < 5 && grid.first.y < 5 ? 1 : 0);
        }
        EXPECT_EQ(firsts.size(), turns);
        EXPECT_EQ(cell_grid(4, spacing, turns).first, cell_grid(4, spacing, 0).first);
    }
}

} // namespace
} // namespace framelet
