#include "server/sampling/field/price.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "server/sampling/plan/patch_selection.h"

namespace framelet {
namespace {

/// A field whose regions hold the finest samples, some of them moving.
RegionField random_field(Viewport viewport, std::mt19937& random) {
    RegionField field{ImagePlane(viewport)};
    auto const between = [&random](float low, float high) {
        return std::exp2(std::uniform_real_distribution<float>(std::log2(low), std::log2(high))(random));
    };
    float const moving = std::uniform_real_distribution<float>(0.05f, 1)(random);
    for (std::uint32_t const index : field.visible()) {
        Region& region = field[index];
        float energy = between(1e-5f, 0.1f);
        for (float& band : region.model.energy) {
            band = energy;
            energy *= between(0.2f, 1);
        }
        bool const moves = std::uniform_real_distribution<float>(0, 1)(random) < moving;
        region.model.motion = moves ? between(0.1f, 50) : 0;
        region.level = 5;
        region.rendered = region.checked = region.refreshed = 10;
        region.changed = 9;
    }
    return field;
}

std::vector<float> due_errors(RegionField const& field, Budget const& budget) {
    std::vector<float> due;
    find_due_errors(field, budget, due);
    return due;
}

TEST(Price, DemandIsTheBudget) {
    std::mt19937 random(1);
    double least = 1e9;
    double most = 0;
    int bounded = 0;
    constexpr int fields = 60;
    for (int n = 0; n < fields; ++n) {
        Viewport const viewport = n % 2 == 0 ? Viewport{256, 256} : Viewport{500, 120};
        RegionField const field = random_field(viewport, random);
        double const pixels = double(viewport.width) * viewport.height;
        Budget const budget{pixels * std::exp2(std::uniform_real_distribution<double>(-1, 6)(random)), 0.02f, 0.03f, 0};
        Choices choices;
        std::vector<float> const due = due_errors(field, budget);
        float price = 1e-6f;
        for (int cycle = 0; cycle < 12; ++cycle) {
            price = solve_price(field, 10, budget, due, price, choices);
        }
        Demand const demand = demand_of(field, budget, due, choices);
        double const ratio = (demand.pressing + demand.refining) / budget.samples_per_second;
        if (price <= 1e-12f) { // everything at its best costs less than there is
            EXPECT_LE(ratio, 1.25);
            ++bounded;
            continue;
        }
        least = std::min(least, ratio);
        most = std::max(most, ratio);
        EXPECT_GT(ratio, 0.5) << n;
        EXPECT_LT(ratio, 2) << n;
        // And there it stays: one cycle more moves it little.
        float const next = solve_price(field, 10, budget, due, price, choices);
        if (ratio > 0.8 && ratio < 1.2) {
            EXPECT_EQ(next, price) << n;
        } else {
            EXPECT_LT(std::abs(std::log2(next / price)), 2) << n;
        }
    }
    std::printf("demand / budget after 12 cycles: %.2f .. %.2f; %d of %d fields need less than there is\n", least, most,
                bounded, fields);
    EXPECT_LT(bounded, fields / 2);
}

/// What is due is dear: a picture of which nothing is held costs more than the same once it is held.
TEST(Price, ABacklogIsDear) {
    std::mt19937 random(2);
    RegionField field = random_field({256, 256}, random);
    Budget const budget{65536.0 * 20, 0.02f, 0.03f, 0};
    Choices choices;
    float held = 1e-6f;
    for (int cycle = 0; cycle < 12; ++cycle) {
        held = solve_price(field, 10, budget, due_errors(field, budget), held, choices);
    }
    for (std::uint32_t const index : field.visible()) {
        field[index].level = -1;
    }
    float bare = held;
    for (int cycle = 0; cycle < 12; ++cycle) {
        bare = solve_price(field, 10, budget, due_errors(field, budget), bare, choices);
    }
    EXPECT_GT(bare, 1.5f * held);
}

TEST(Price, SelectionStopsAtTheBudget) {
    std::mt19937 random(3);
    for (int n = 0; n < 40; ++n) {
        RegionField field = random_field({300, 200}, random);
        for (std::uint32_t const index : field.visible()) {
            field[index].drift = 64 * static_cast<float>(random() % 2);
            field[index].refreshed = static_cast<double>(random() % 10);
        }
        double const pixels = 300 * 200;
        Budget const budget{pixels * std::exp2(static_cast<double>(random() % 8)), 0.02f, 0.03f, 0};
        double const samples = budget.samples_per_second * static_cast<double>(budget.cycle_seconds);
        Choices choices;
        std::vector<float> const due = due_errors(field, budget);
        solve_price(field, 10, budget, due, 1e-6f, choices);
        std::vector<float> density(field.size());
        for (std::uint32_t const index : field.visible()) {
            density[index] = samples_per_pixel(choices[index].level);
        }
        TilingScratch scratch;
        std::vector<Patch> cut;
        make_density_patches(field.plane(), density, field.depth(), scratch, cut);
        std::vector<RatedPatch> rated;
        rate_patches(field, choices, due, cut, budget, rated);
        std::vector<int> times(field.size()); // that each region is in one of them
        for (RatedPatch const& entry : rated) {
            RegionField::Range const range = field.range_of(entry.patch.node);
            std::for_each(times.begin() + range.first, times.begin() + range.last, [](int& count) { ++count; });
        }
        EXPECT_LE(std::ranges::max(times), 1);
        select_patches(samples, samples, rated);
        double spent = 0;
        for (std::size_t i = 0; i < rated.size(); ++i) {
            EXPECT_LT(spent, samples) << "the last may exceed it, no other";
            EXPECT_GT(rated[i].urgency, 0);
            EXPECT_TRUE(i == 0 || rated[i - 1].urgency >= rated[i].urgency);
            spent += rated[i].samples;
        }
        std::vector<std::uint32_t> suspects;
        std::vector<Patch> periodic_refreshes;
        select_periodic_refreshes(field, 12 + refresh_period(field, budget), budget, suspects, periodic_refreshes);
        double looked = 0;
        for (Patch const& patch : periodic_refreshes) {
            EXPECT_LT(looked, 0.05 * samples);
            EXPECT_EQ(field.level_of(patch.depth), pixel_level);
            looked += framelet_samples * std::ldexp(1.0, 2 * (patch.depth - patch.node.depth()));
        }
        EXPECT_GT(looked, 0);
    }
}

} // namespace
} // namespace framelet
