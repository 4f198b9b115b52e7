#include "tests/evaluation/settling.h"

#include <algorithm>
#include <vector>

#include "common/error.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {

Settling measure_settling(std::span<double const> times, std::span<double const> errors, double event, double factor) {
    FRAMELET_CHECK(times.size() == errors.size() && times.size() >= 4 && factor > 1);
    std::size_t const tail = times.size() - times.size() / 4;
    Settling result;
    result.final_level =
        std::max(median({errors.begin() + static_cast<std::ptrdiff_t>(tail), errors.end()}), settled_floor);
    result.peak = *std::ranges::max_element(errors);
    std::size_t settled = times.size();
    while (settled > 0 && errors[settled - 1] <= factor * result.final_level) {
        --settled;
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!result.first && errors[i] <= factor * result.final_level) {
            result.first = times[i] - event;
        }
        if (result.first) {
            result.overshoot = std::max(result.overshoot, errors[i] / result.final_level);
        }
    }
    if (settled < tail) {
        result.settled = times[settled] - event;
    }
    return result;
}

} // namespace framelet::bench
