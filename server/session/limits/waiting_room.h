// The connections that have not said hello yet: how many there may be, of one source and of all. In: connections as
// they come and go, and chance as a number. Out: which one has to go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace framelet {

/// Drops early and at random, as OpenSSH's MaxStartups does, but one that waits and not the one that comes: a viewer
/// that knows the token waits for a moment, a connection that never says hello until its time is over, so that the
/// latter are hit.
class WaitingRoom {
public:
    static constexpr std::size_t most_of_a_source = 16;
    /// With so many waiting, a newcomer costs one of them its place with a probability of `least_drop`, which grows to
    /// 1 where it would be one more than `most`.
    static constexpr std::size_t early = 32;
    static constexpr std::size_t most = 64;
    static constexpr double least_drop = 0.3;

    /// Takes in `connection`. Returns the one that has to go for it, one of the source that has most of them, or of its
    /// own where that has its share; it does not wait any more. `chance` is evenly distributed in 0..1, without 1.
    std::optional<std::uint64_t> enter(std::uint64_t connection, std::string const& source, double chance);
    /// Removes a connection, whether it waits or not.
    void leave(std::uint64_t connection) { waiting_.erase(connection); }

private:
    std::vector<std::uint64_t> of_source(std::string const& source) const;
    std::string fullest_source() const;

    std::map<std::uint64_t, std::string> waiting_; ///< with their sources
};

} // namespace framelet
