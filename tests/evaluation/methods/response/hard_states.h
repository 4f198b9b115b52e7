// Densities, bounds and errors to try the response with: random ones and those that break arithmetic.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "tests/evaluation/methods/response/density.h"
#include "tests/evaluation/methods/response/rate_error.h"

namespace framelet {

class HardStates {
public:
    explicit HardStates(unsigned seed) : random_(seed) {}

    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
    double uniform(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }

    /// Random bounds: ranges of all sizes, some empty, some of tiny or huge numbers.
    DensityBounds bounds() {
        auto const range = [&](double& least, double& most) {
            least = std::exp2(below(8) == 0 ? uniform(-200, 200) : uniform(-8, 4));
            most = below(16) == 0 ? least : least * std::exp2(uniform(0, 12));
        };
        DensityBounds out;
        range(out.least.space, out.most.space);
        range(out.least.time, out.most.time);
        return out;
    }

    /// Random density within the bounds, often exactly on one or next to it.
    Density density(DensityBounds const& bounds) {
        auto const value = [&](double least, double most) {
            switch (below(8)) {
            case 0:
                return least;
            case 1:
                return most;
            case 2:
                return std::min(most, std::nextafter(least, most));
            case 3:
                return std::max(least, std::nextafter(most, least));
            default:
                return std::clamp(least * std::pow(most / least, uniform(0, 1)), least, most);
            }
        };
        return {value(bounds.least.space, bounds.most.space), value(bounds.least.time, bounds.most.time)};
    }

    RateError error() {
        constexpr std::array<float, 8> hard{0.0f,    -0.0f,  1.0f, -1.0f, std::numeric_limits<float>::denorm_min(),
                                            -1e-40f, 1e-20f, 3e38f};
        auto const value = [&] {
            return below(4) == 0 ? hard[below(hard.size())] : static_cast<float>(uniform(-1, 1));
        };
        return {value(), value()};
    }

private:
    std::mt19937_64 random_;
};

inline bool is_within(Density at, DensityBounds const& bounds) {
    return at.space >= bounds.least.space && at.space <= bounds.most.space && at.time >= bounds.least.time &&
           at.time <= bounds.most.time;
}

} // namespace framelet
