// Figures that a server tells those who watch over it, not its viewers. In: figures. Out: a page in the text format
// that Prometheus reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace framelet {

/// Figures since the server's start.
struct ServerFigures {
    bool healthy = false; ///< its threads do what they are there for
    bool ready = false; ///< another viewer is welcome
    double busy = 0; ///< share of the last second in which there was something to do, about
    std::size_t sessions = 0; ///< that are open
    std::uint64_t viewers = 0; ///< viewers that were let in
    std::uint64_t scenes = 0; ///< scenes that were served
    std::uint64_t sent_bytes = 0; ///< bytes sent to viewers
    std::size_t workers = 0; ///< that trace paths for it
    std::uint64_t worker_paths = 0; ///< paths that they have traced
    double rays = 0; ///< rendered for framelets
    double rays_per_second = 0; ///< rays a second that it would render with all its time, as learnt
    double busy_seconds = 0; ///< seconds in which its loop had something to do
    std::uint64_t resident_bytes = 0; ///< memory of the process; 0: the system does not say
};

std::string metrics_text(ServerFigures const& figures);

/// Memory of this process, bytes; 0 where the system does not say.
std::uint64_t resident_bytes();

} // namespace framelet
