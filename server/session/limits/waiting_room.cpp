#include "server/session/limits/waiting_room.h"

#include <algorithm>

namespace framelet {
namespace {

double drop_probability(std::size_t waiting) {
    if (waiting < WaitingRoom::early) {
        return 0;
    }
    double const fullness =
        static_cast<double>(waiting - WaitingRoom::early) / static_cast<double>(WaitingRoom::most - WaitingRoom::early);
    return std::min(1.0, WaitingRoom::least_drop + (1 - WaitingRoom::least_drop) * fullness);
}

} // namespace

std::optional<std::uint64_t> WaitingRoom::enter(std::uint64_t connection, std::string const& source, double chance) {
    std::vector<std::uint64_t> candidates = of_source(source);
    double probability = 1;
    if (candidates.size() < most_of_a_source) {
        probability = drop_probability(waiting_.size());
        candidates = of_source(fullest_source());
    }
    std::optional<std::uint64_t> dropped;
    if (chance < probability) {
        // Given that it is less than the probability, their quotient is evenly distributed again.
        auto const place = static_cast<std::size_t>(chance / probability * static_cast<double>(candidates.size()));
        dropped = candidates[std::min(place, candidates.size() - 1)];
        waiting_.erase(*dropped);
    }
    waiting_.emplace(connection, source);
    return dropped;
}

std::vector<std::uint64_t> WaitingRoom::of_source(std::string const& source) const {
    std::vector<std::uint64_t> found;
    for (auto const& [connection, its_source] : waiting_) {
        if (its_source == source) {
            found.push_back(connection);
        }
    }
    return found;
}

std::string WaitingRoom::fullest_source() const {
    std::map<std::string, std::size_t> counts;
    for (auto const& [connection, source] : waiting_) {
        ++counts[source];
    }
    auto const fullest = std::max_element(counts.begin(), counts.end(),
                                          [](auto const& one, auto const& two) { return one.second < two.second; });
    return fullest == counts.end() ? std::string() : fullest->first;
}

} // namespace framelet
