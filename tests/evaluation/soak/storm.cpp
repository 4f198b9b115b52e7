#include "tests/evaluation/soak/storm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace framelet::bench {
namespace {

constexpr std::array<std::string_view, storm_event_kinds> names{
    "resize",          "cut",         "settings",     "clock",   "killed program",
    "stopped program", "slow reader", "half message", "garbage", "rush"};

constexpr double longest_visit = 3; ///< greatest length of a visit, seconds

/// Random numbers that are the same with every standard library, whose distributions need not be.
class Chance {
public:
    explicit Chance(std::uint64_t seed) : random_(seed) {}

    double next() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    /// One of `count` numbers from 0 on, each as likely.
    int choice(int count) { return static_cast<int>(next() * count); }
    /// Seconds until the next event, where so many come a second.
    double gap(double per_second) { return -std::log1p(-next()) / per_second; }

private:
    std::mt19937_64 random_;
};

} // namespace

std::string_view name_of(StormEvent event) {
    return names[static_cast<std::size_t>(event)];
}

std::vector<StormMoment> make_storm(StormParameters const& parameters) {
    constexpr int viewer_kinds = static_cast<int>(StormEvent::clock) + 1;
    Chance chance(parameters.seed);
    std::vector<StormMoment> storm;
    auto const add = [&](double per_second, int first_kind, int kinds, int viewers) {
        for (double time = chance.gap(per_second); time < parameters.seconds; time += chance.gap(per_second)) {
            StormMoment moment;
            moment.time = time;
            moment.event = static_cast<StormEvent>(first_kind + chance.choice(kinds));
            moment.viewer = viewers > 0 ? chance.choice(viewers) : static_cast<int>(storm.size());
            moment.seconds = std::min(longest_visit * chance.next(), parameters.seconds - time);
            moment.chance = chance.next();
            storm.push_back(moment);
        }
    };
    add(parameters.viewer_events_per_second * parameters.viewers, 0, viewer_kinds, parameters.viewers);
    add(parameters.visits_per_second, viewer_kinds, storm_event_kinds - viewer_kinds, 0);
    std::ranges::stable_sort(storm, {}, &StormMoment::time);
    return storm;
}

} // namespace framelet::bench
