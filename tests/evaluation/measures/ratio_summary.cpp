#include "tests/evaluation/measures/ratio_summary.h"

#include <algorithm>
#include <vector>

#include "common/error.h"

namespace framelet::bench {

RatioSummary summarise_ratios(std::span<double const> ratios) {
    if (ratios.empty() || !std::ranges::all_of(ratios, [](double ratio) { return ratio >= 0; })) {
        throw InputError("error ratios must be numbers, not below zero, at least one");
    }
    std::vector<double> sorted(ratios.begin(), ratios.end());
    std::ranges::sort(sorted);
    double const low = sorted[(sorted.size() - 1) / 2], high = sorted[sorted.size() / 2];
    auto const suitable = static_cast<double>(std::ranges::count_if(sorted, [](double ratio) { return ratio <= 1; }));
    return {low == high ? low : 0.5 * (low + high), 100 * suitable / static_cast<double>(sorted.size())};
}

} // namespace framelet::bench
