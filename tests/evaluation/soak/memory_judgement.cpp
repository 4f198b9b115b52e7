#include "tests/evaluation/soak/memory_judgement.h"

#include <algorithm>
#include <cstdio>
#include <span>

namespace framelet::bench {

MemoryJudgement judge_memory(std::array<std::vector<double>, 4> const& bytes, std::string const& whose) {
    std::size_t const pairs = std::min(bytes[2].size(), bytes[3].size());
    char text[200];
    if (pairs < least_pairs) {
        std::snprintf(text, sizeof text,
                      " memory is NOT JUDGED: %zu pairs of calms in the last two quarters, %zu are needed", pairs,
                      least_pairs);
        return {std::nullopt, false, whose + text};
    }
    Growth const growth = growth_of(std::span(bytes[2]).first(pairs), std::span(bytes[3]).first(pairs));
    std::snprintf(text, sizeof text,
                  " memory has grown by %+.2f MB in a quarter of the time, standard error %.2f, of %.1f MB, %zu pairs",
                  1e-6 * growth.mean, 1e-6 * growth.error, 1e-6 * growth.before, pairs);
    return {growth, grows(growth, memory_noise), whose + text};
}

} // namespace framelet::bench
