// What a server tells those who watch over it, not its viewers. In: figures. Out: a page in the text format that
// Prometheus reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace framelet {

/// Since the server's start.
struct ServerFigures {
    bool healthy = false; ///< its threads do what they are there for
    std::size_t sessions = 0; ///< that are open
    std::uint64_t viewers = 0; ///< that were let in
    std::uint64_t scenes = 0; ///< that were served
    std::uint64_t sent_bytes = 0; ///< to viewers
    double rays = 0; ///< rendered for framelets
    double rays_per_second = 0; ///< that it would render with all its time, as learnt
    double busy_seconds = 0; ///< that its loop had something to do
    std::uint64_t resident_bytes = 0; ///< memory of the process; 0: the system does not say
};

std::string metrics_text(ServerFigures const& figures);

/// Of this process; 0 where the system does not say.
std::uint64_t resident_bytes();

} // namespace framelet
