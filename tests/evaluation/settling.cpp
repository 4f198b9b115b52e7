#include "tests/evaluation/settling.h"

#include <algorithm>
#include <vector>

#include "common/error.h"

namespace framelet::bench {

Settling measure_settling(std::span<double const> times, std::span<double const> errors, double event, double factor) {
    FRAMELET_CHECK(times.size() == errors.size() && times.size() >= 4 && factor > 1);
    std::size_t const tail = times.size() - times.size() / 4;
    std::vector<double> last(errors.begin() + static_cast<std::ptrdiff_t>(tail), errors.end());
    auto const middle = last.begin() + static_cast<std::ptrdiff_t>(last.size() / 2);
    std::ranges::nth_element(last, middle);
    Settling result;
    result.final_level = std::max(*middle, settled_floor);
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
