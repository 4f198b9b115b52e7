#include "tests/evaluation/cycle_log.h"

#include <algorithm>
#include <cmath>

namespace framelet::bench {
namespace {

bool before(Patch const& a, Patch const& b) {
    return a.node != b.node ? a.node < b.node : a.depth < b.depth;
}

bool is_within(CycleEntry const& entry, double from, double until) {
    return entry.start >= from && entry.start < until;
}

} // namespace

void CycleLog::add(double start, AdaptiveRefresh const& refresh, std::uint64_t samples) {
    if (refresh.cycle_count() != cycle_) {
        cycle_ = refresh.cycle_count();
        std::vector<Patch> cut = refresh.cut();
        std::ranges::sort(cut, before);
        auto const kept = std::ranges::count_if(
            cut, [this](Patch const& patch) { return std::ranges::binary_search(cut_, patch, before); });
        entries_.push_back({start, refresh.cycle_budget() / refresh.cycle_seconds(), 0,
                            static_cast<double>(refresh.price()), cut.size(),
                            cut.size() - static_cast<std::size_t>(kept)});
        cut_ = std::move(cut);
    }
    if (!entries_.empty()) {
        entries_.back().samples += static_cast<double>(samples);
    }
}

Hunting measure_hunting(std::vector<CycleEntry> const& entries, double from, double until) {
    Hunting result;
    for (std::size_t i = 1; i < entries.size(); ++i) {
        if (is_within(entries[i], from, until)) {
            ++result.cycles;
            result.changed_share += static_cast<double>(entries[i].changed_patches) /
                                    static_cast<double>(std::max<std::size_t>(entries[i].patches, 1));
            result.price_octaves += std::abs(std::log2(entries[i].price / entries[i - 1].price));
        }
    }
    double const count = std::max(static_cast<double>(result.cycles), 1.0);
    result.changed_share /= count;
    result.price_octaves /= count;
    return result;
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
