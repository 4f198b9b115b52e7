#include "tests/evaluation/rival_choice.h"

#include <algorithm>

#include "common/error.h"

namespace framelet::bench {

std::vector<RivalParts> rival_choices(std::string_view method, RivalParts const& parts) {
    std::vector<int> const spacings = parts.spacing > 0     ? std::vector{parts.spacing}
                                      : has_spacing(method) ? std::vector{1, 2, 4}
                                                            : std::vector{1};
    std::vector<double> const margins = parts.margin >= 0    ? std::vector{parts.margin}
                                        : has_margin(method) ? std::vector{0.0, 0.125}
                                                             : std::vector{0.0};
    std::vector<RivalParts> choices;
    for (int const spacing : spacings) {
        for (double const margin : margins) {
            choices.push_back({parts.accumulate, parts.ahead, spacing, margin});
        }
    }
    return choices;
}

std::size_t best_choice(std::vector<double> const& errors) {
    FRAMELET_CHECK(!errors.empty());
    return static_cast<std::size_t>(std::ranges::min_element(errors) - errors.begin());
}

} // namespace framelet::bench
