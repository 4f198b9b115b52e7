#include "server/sampling/plan/patch_selection.h"

#include <algorithm>

namespace framelet {
namespace {

constexpr double least_refresh_period = 2;

struct Gain {
    double error = 0; ///< error that refreshing takes away, beyond what is tolerated, summed over pixels
    double pixels = 0;
    double cost = 0; ///< of a sample, summed over pixels
    bool spoils = false; ///< it would put something coarser over what is finer and still true
};

Gain gain_of(RegionField const& field, Choices const& choices, std::span<float const> due, Budget const& budget,
             RegionField::Range range, int level) {
    Gain gain;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        Region const& region = field[i];
        auto const pixels = static_cast<double>(field.pixels_of(i));
        gain.pixels += pixels;
        gain.cost += pixels * static_cast<double>(costs_at(budget, i)[static_cast<std::size_t>(level)]);
        if (pixels == 0 || region.taken.level >= 0) { // what a refresh is worth is seen once that is learnt
            continue;
        }
        gain.spoils =
            gain.spoils || (region.level > level && region.drift == 0 && (budget.still || region.model.motion == 0));
        float const unresolved = unresolved_error(region.model, level);
        float fresh = unresolved + drift_error(region.model, level, drift_on_the_way(region, budget));
        if (region.rendered >= budget.moment_begun) { // a later look at this moment can only show more detail
            float const detail = level > region.level ? unresolved_error(region.model, region.level) - unresolved : 0;
            fresh = due[i] - std::max(detail, 0.0f);
        }
        gain.error += pixels * static_cast<double>(due[i] - std::max(choices[i].due_error, fresh));
    }
    return gain;
}

} // namespace

void rate_patches(RegionField const& field, Choices const& choices, std::span<float const> due,
                  std::vector<Patch> const& cut, Budget const& budget, std::vector<RatedPatch>& rated) {
    rated.clear();
    auto const rate = [&](Patch const& patch) {
        Gain const gain = gain_of(field, choices, due, budget, field.range_of(patch.node), field.level_of(patch.depth));
        if (!gain.spoils) {
            double const samples = framelet_samples * tile_count(patch);
            double const cost = samples * (gain.pixels > 0 ? gain.cost / gain.pixels : 1);
            rated.push_back({patch, samples, cost, gain.error / cost});
        }
        return !gain.spoils;
    };
    for (Patch const& patch : cut) {
        if (rate(patch)) {
            continue;
        }
        // Regions that are true must not keep the others waiting: rates each region by itself.
        RegionField::Range const range = field.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last && range.last - range.first > 1; ++i) {
            if (field.pixels_of(i) > 0) {
                rate(field.patch_of(i, std::max(patch.depth, field.depth())));
            }
        }
    }
}

void select_patches(double budget, double most_samples, std::vector<RatedPatch>& rated) {
    std::erase_if(rated, [](RatedPatch const& entry) { return !(entry.urgency > 0); });
    std::sort(rated.begin(), rated.end(), [](RatedPatch const& a, RatedPatch const& b) {
        return a.urgency != b.urgency ? a.urgency > b.urgency : a.patch.node < b.patch.node;
    });
    double spent = 0;
    double samples = 0;
    std::size_t count = 0;
    while (count < rated.size() && spent < budget && samples < most_samples) {
        spent += rated[count].cost;
        samples += rated[count].samples;
        ++count;
    }
    rated.resize(count);
}

bool append_new(Patch const& patch, std::size_t count, std::vector<Patch>& patches) {
    auto const end = patches.begin() + static_cast<std::ptrdiff_t>(count);
    bool const is_new = std::find(patches.begin(), end, patch) == end;
    if (is_new) {
        patches.push_back(patch);
    }
    return is_new;
}

double refresh_period(RegionField const& field, Budget const& budget) {
    Viewport const viewport = field.plane().viewport();
    double const pixels = static_cast<double>(viewport.width) * viewport.height;
    return std::max(least_refresh_period, pixels / (budget.limits.periodic_share * budget.samples_per_second));
}

void select_periodic_refreshes(RegionField const& field, double now, Budget const& budget,
                               std::vector<std::uint32_t>& scratch, std::vector<Patch>& patches) {
    double const latest = now - refresh_period(field, budget);
    scratch.clear();
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        if (region.refreshed < latest && region.taken.level < pixel_level) {
            scratch.push_back(index);
        }
    }
    std::sort(scratch.begin(), scratch.end(), [&field](std::uint32_t a, std::uint32_t b) {
        return field[a].refreshed != field[b].refreshed ? field[a].refreshed < field[b].refreshed : a < b;
    });
    double samples =
        budget.limits.periodic_share * budget.samples_per_second * static_cast<double>(budget.cycle_seconds);
    for (std::uint32_t const index : scratch) {
        if (samples <= 0) {
            return;
        }
        Patch const patch = field.patch_of(index, field.plane().pixel_depth());
        if (append_new(patch, patches.size(), patches)) {
            samples -= framelet_samples * tile_count(patch);
        }
    }
}

} // namespace framelet
