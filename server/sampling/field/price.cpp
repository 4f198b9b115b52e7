#include "server/sampling/field/price.h"

#include <algorithm>
#include <cmath>

namespace framelet {
namespace {

/// Regions that are no longer true should be rendered again within so many cycles.
constexpr double stale_cycles = 3;
/// Seconds within which regions that are true but coarse should be refined: they can wait longer.
constexpr double coarse_seconds = 0.12;
/// The bounds of the seconds for which a region is expected to stay as it is: about as long as it has stayed so far.
constexpr float least_life = 0.1f;
constexpr float most_life = 4;
constexpr float least_rest = 0.3f; ///< the lower bound once nothing moves

float expected_life(Region const& region, double now, bool all_stands) {
    float const still = static_cast<float>(std::min(now - region.changed, static_cast<double>(most_life)));
    if (all_stands) {
        return std::clamp(still, least_rest, most_life);
    }
    float const motion = region.model.motion;
    float const passing = motion > 2 / most_life ? 2 / motion : most_life;
    return std::clamp(std::max(still, passing), least_life, most_life);
}

void choose_all(RegionField const& field, double now, Budget const& budget, float price, Choices& choices) {
    SamplingPrice const terms{price, budget.latency, budget.cycle_seconds, budget.bias};
    int const least_level = std::max(field.least_level(), budget.limits.least_level);
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        RegionModel model = region.model;
        if (budget.still) {
            model.motion = 0;
        }
        choices[index] = choose_sampling(model, expected_life(region, now, budget.still), terms, least_level,
                                         budget.limits.most_level, costs_at(budget, index));
    }
}

} // namespace

float drift_on_the_way(Region const& region, Budget const& budget) {
    return budget.still ? 0 : region.model.motion * budget.latency;
}

void find_due_errors(RegionField const& field, Budget const& budget, std::vector<float>& due) {
    due.resize(field.size());
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        due[index] = shown_error(region, drift_on_the_way(region, budget));
    }
}

Demand demand_of(RegionField const& field, Budget const& budget, std::span<float const> due, Choices const& choices) {
    double steady = 0;
    double stale = 0;
    double coarse = 0;
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        SamplingChoice const& choice = choices[index];
        double const samples = static_cast<double>(field.pixels_of(index) * samples_per_pixel(choice.level) *
                                                   costs_at(budget, index)[static_cast<std::size_t>(choice.level)]);
        steady += choice.recurring ? samples / static_cast<double>(choice.period) : 0;
        float const error = due[index];
        if (error > choice.due_error) {
            bool const is_true = region.taken.level < 0 && region.level >= 0 &&
                                 unresolved_error(region.model, region.level) > 0.5f * error;
            (is_true ? coarse : stale) += samples;
        }
    }
    return {std::max(steady, stale / (stale_cycles * static_cast<double>(budget.cycle_seconds))),
            coarse / coarse_seconds};
}

float solve_price(RegionField const& field, double now, Budget const& budget, std::span<float const> due,
                  float last_price, Choices& choices) {
    choices.resize(field.size());
    constexpr int most_steps = 4;
    float const least_price = budget.limits.least_price;
    float const most_price = budget.limits.most_price;
    float price = std::clamp(last_price, least_price, most_price);
    for (int step = 0;; ++step) {
        choose_all(field, now, budget, price, choices);
        Demand const demand = demand_of(field, budget, due, choices);
        double ratio = (demand.pressing + demand.refining) / budget.samples_per_second;
        if (ratio > 1) { // refinement can wait
            ratio = std::max(demand.pressing / budget.samples_per_second, 1.0);
        }
        // Demand falls about as the square root of the price, faster where it makes levels coarser: far away in large
        // steps, near by in small ones, that do not overshoot. Downwards a level at most, so that none is left out.
        bool const near = ratio > 0.25 && ratio < 4;
        float const factor = static_cast<float>(near ? ratio : std::clamp(ratio * std::sqrt(ratio), 0.25, 64.0));
        price = std::clamp(ratio > 0.8 && ratio < 1.2 ? price : price * factor, least_price, most_price);
        // What remains to be corrected is left to the next cycle, unless it is much.
        if (step == most_steps || (ratio > 0.5 && ratio < 2)) {
            return price;
        }
    }
}

} // namespace framelet
