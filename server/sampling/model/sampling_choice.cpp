#include "server/sampling/model/sampling_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace framelet {
namespace {

/// x with 1 - exp(-x)(1 + x) = cost, by a table over sqrt(cost), interpolated: x is nearly linear in that. `cost` is in
/// [0, 1).
class BestPeriod {
public:
    BestPeriod() {
        for (std::size_t i = 0; i <= steps; ++i) {
            double const root = static_cast<double>(i) / steps;
            double low = 0;
            double high = 40;
            for (int step = 0; step < 50; ++step) {
                double const x = 0.5 * (low + high);
                (1 - std::exp(-x) * (1 + x) < root * root ? low : high) = x;
            }
            periods_[i] = static_cast<float>(high);
        }
    }
    float operator()(float cost) const {
        float const position = std::sqrt(cost) * steps;
        std::size_t const i = std::min(static_cast<std::size_t>(position), steps - 1);
        return periods_[i] + (position - static_cast<float>(i)) * (periods_[i + 1] - periods_[i]);
    }

private:
    static constexpr std::size_t steps = 1024;
    std::array<float, steps + 1> periods_{};
};

BestPeriod const best_period;

} // namespace

SamplingChoice choose_sampling(RegionModel const& region, float life, SamplingPrice const& price, int least_level,
                               int most_level, LevelCosts const& costs) {
    BiasWeights const weights(price.bias);
    float const longest = std::max(life, price.least_period);
    LevelErrors const errors = level_errors(region);
    SamplingChoice best;
    float least = std::numeric_limits<float>::infinity();
    /// Weighs a level, unless what it leaves unresolved alone is too much already.
    auto const offer = [&](int level) {
        float const unresolved = weights.space * errors.unresolved[static_cast<std::size_t>(level)];
        float const cost = price.price * samples_per_pixel(level) * costs[static_cast<std::size_t>(level)];
        if (unresolved + cost / longest >= least) {
            return;
        }
        float period = longest;
        float paid = unresolved + cost / longest;
        if (region.motion > 0) {
            DriftBounds const bounds = errors.drift[static_cast<std::size_t>(level)];
            float const most = weights.time * bounds.most;
            float const rate = region.motion * bounds.growth / bounds.most; // 1/s, of the one exponential
            float const left = most * std::exp(-rate * price.latency); // what a refresh can save, fresh as it comes
            float const share = rate * cost / left;
            float const wanted = share < 1 && rate > 0 ? best_period(share) / rate : longest;
            period = std::clamp(wanted, price.least_period, longest);
            float const x = rate * period;
            // 1 - (1 - exp(-x)) / x, which cancels where x is small.
            float const mean_lost = x > 0.1f ? 1 - (1 - std::exp(-x)) / x : x * (0.5f - x * (1.0f / 6 - x / 24));
            paid = unresolved + (most - left) + left * mean_lost + cost / period;
        }
        if (paid < least) {
            least = paid;
            // The error that is shown knows no bias: takes it out again.
            float const due = unresolved / weights.space + (paid - unresolved) / weights.time;
            best = {level, period, due, period < life};
        }
    };
    // Goes from the middle outwards: the best is mostly near, and what is far then need not be weighed.
    int const middle = std::clamp(pixel_level, least_level, most_level);
    for (int level = middle; level >= least_level; --level) {
        offer(level);
    }
    for (int level = middle + 1; level <= most_level; ++level) {
        offer(level);
    }
    return best;
}

} // namespace framelet
