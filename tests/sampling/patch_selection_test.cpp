#include "server/sampling/plan/patch_selection.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(PeriodicRefresh, LooksAtEveryRegionAndTakesNoTileTwice) {
    RegionField const field{ImagePlane({128, 128})};
    int const fine = field.plane().pixel_depth();
    std::vector<Patch> patches{{make_tile(field.depth(), 3, 5), fine}, {Tile{1}.child(1), fine - 1}};
    std::vector<std::uint32_t> scratch;
    select_periodic_refreshes(field, 100, {.samples_per_second = 1e9, .cycle_seconds = 1}, scratch, patches);

    std::vector<Tile> tiles;
    for (Patch const& patch : patches) {
        append_tiles(field.plane(), patch, tiles);
    }
    std::ranges::sort(tiles);
    EXPECT_EQ(std::ranges::adjacent_find(tiles), tiles.end()) << "a tile twice";
    EXPECT_EQ(std::ranges::count(tiles, fine, &Tile::depth), 64) << "every region is looked at";
}

TEST(RatedPatches, WhatIsTrueKeepsItsNeighboursNotWaiting) {
    RegionField field{ImagePlane({128, 128})};
    Choices choices(field.size());
    std::vector<float> due(field.size(), 0.1f); // all are wrong
    for (std::uint32_t const index : field.visible()) {
        field[index].level = pixel_level;
        field[index].drift = 64;
        field[index].model.energy.fill(1e-6f);
    }
    std::vector<Patch> const cut{{Tile{1}.child(0), field.depth() - 2}}; // coarser than a region is
    std::vector<RatedPatch> rated;
    rate_patches(field, choices, due, cut, {}, rated);
    ASSERT_EQ(rated.size(), 1u);
    EXPECT_GT(rated[0].urgency, 0);

    field[0].drift = 0; // but one
    due[0] = 0;
    rate_patches(field, choices, due, cut, {}, rated);
    ASSERT_EQ(rated.size(), std::size_t{field.range_of(cut[0].node).last});
    for (RatedPatch const& entry : rated) {
        EXPECT_EQ(entry.patch.node.depth(), field.depth());
        EXPECT_EQ(entry.urgency > 0, field.range_of(entry.patch.node).first != 0);
    }
}

/// Once nothing moves, what was learnt of the motion of regions says nothing of what the viewer holds.
TEST(RatedPatches, WhatIsTrueGetsNoCoarserOnceAllStands) {
    RegionField field{ImagePlane({128, 128})};
    for (std::uint32_t const index : field.visible()) {
        field[index].level = pixel_level;
        field[index].model.energy.fill(1e-3f);
        field[index].model.motion = 100;
    }
    Choices const choices(field.size());
    std::vector<Patch> const cut{{Tile{1}.child(0), field.depth() - 2}};
    std::vector<float> due;
    std::vector<RatedPatch> rated;
    Budget budget{.samples_per_second = 1e6, .latency = 0.02f};
    auto const is_wanted = [&] {
        find_due_errors(field, budget, due);
        rate_patches(field, choices, due, cut, budget, rated);
        return std::ranges::any_of(rated, [](RatedPatch const& entry) { return entry.urgency > 0; });
    };
    EXPECT_TRUE(is_wanted());
    budget.still = true;
    EXPECT_FALSE(is_wanted());
    field[0].drift = 1; // what is no longer true is rendered again
    EXPECT_TRUE(is_wanted());
}

/// Patches that take away the same error go in the order of their cost, and neither what is spent nor the samples
/// exceed what there is by more than the last patch.
TEST(SelectedPatches, CheaperOnesGoFirst) {
    RegionField field{ImagePlane({128, 128})};
    for (std::uint32_t const index : field.visible()) {
        field[index].level = pixel_level;
        field[index].drift = 64;
        field[index].model.energy.fill(1e-6f);
    }
    Choices const choices(field.size());
    std::vector<float> const due(field.size(), 0.1f);
    std::vector<LevelCosts> costs(field.size(), equal_costs);
    for (std::uint32_t const index : field.visible()) {
        costs[index].fill(0.25f + 0.125f * static_cast<float>((index * 37) % 16));
    }
    std::vector<Patch> cut;
    for (std::uint32_t const index : field.visible()) {
        cut.push_back({{(1u << (2 * field.depth())) + index}, field.plane().pixel_depth()});
    }
    std::vector<RatedPatch> all;
    rate_patches(field, choices, due, cut, {.costs = costs}, all);
    ASSERT_EQ(all.size(), cut.size());
    for (auto const& [budget, most] : {std::pair{8.0, 1e9}, {1e9, 8.0}, {8.0, 4.0}}) {
        std::vector<RatedPatch> rated = all;
        select_patches(budget * framelet_samples, most * framelet_samples, rated);
        double cost = 0, samples = 0;
        for (std::size_t i = 0; i < rated.size(); ++i) {
            EXPECT_LT(cost, budget * framelet_samples);
            EXPECT_LT(samples, most * framelet_samples);
            EXPECT_TRUE(i == 0 || rated[i].cost >= rated[i - 1].cost);
            cost += rated[i].cost;
            samples += rated[i].samples;
        }
        EXPECT_TRUE(cost >= budget * framelet_samples || samples >= most * framelet_samples);
    }
}

} // namespace
} // namespace framelet
