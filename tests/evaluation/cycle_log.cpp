#include "tests/evaluation/cycle_log.h"

#include <algorithm>

namespace framelet::bench {
namespace {

bool is_within(CycleEntry const& entry, double from, double until) {
    return entry.start >= from && entry.start < until;
}

} // namespace

void CycleLog::add(double start, AdaptiveRefresh const& refresh, std::uint64_t samples) {
    if (refresh.cycle_count() != cycle_) {
        cycle_ = refresh.cycle_count();
        entries_.push_back({start, refresh.cycle_budget() / refresh.cycle_seconds(), 0});
    }
    if (!entries_.empty()) {
        entries_.back().samples += static_cast<double>(samples);
    }
}

Conservation measure_conservation(std::vector<CycleEntry> const& entries, double from, double until) {
    Conservation result;
    for (std::size_t first = 0; first + 1 < entries.size(); ++first) {
        if (!is_within(entries[first], from, until)) {
            continue;
        }
        // A cycle lasts until the next one starts, so that the last one's length is not known.
        double samples = 0;
        double budget = 0;
        for (std::size_t i = first; i + 1 < entries.size(); ++i) {
            samples += entries[i].samples;
            budget += entries[i].rate * (entries[i + 1].start - entries[i].start);
            if (i == first) {
                result.samples += samples;
                result.budget += budget;
            }
            if (entries[i + 1].start - entries[first].start >= least_window) {
                result.largest_share = std::max(result.largest_share, samples / budget);
                break;
            }
        }
    }
    return result;
}

} // namespace framelet::bench
