// What happens to a server and its viewers while it storms. In: how many viewers, how long, a seed. Out: events in the
// order of their times; the same in, the same out, so that a storm that found something can be had again.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace framelet::bench {

enum class StormEvent : std::uint8_t {
    // To one of the viewers that stay:
    resize, ///< its picture gets another size
    cut, ///< its connection ends amid whatever is on its way; it comes back by itself
    settings, ///< it wants another exposure, or moves nothing
    clock, ///< it asks for another time of the scene, to play, or to pause
    // By somebody who comes for it and goes:
    killed_program, ///< framelet-client, which is killed at the end
    stopped_program, ///< the same, but first it is stopped for half of the time: to the server it reads nothing
    slow_reader, ///< asks for a large picture and reads nothing of it
    half_message, ///< ends amid a message
    garbage, ///< sends what is no message
    rush, ///< many who say hello, ask for a picture and are gone, one after the other
};
inline constexpr int storm_event_kinds = 10;

/// As it is called in tables.
std::string_view name_of(StormEvent event);
/// Whether it happens to one of the viewers that stay.
constexpr bool is_of_viewer(StormEvent event) {
    return event <= StormEvent::clock;
}

struct StormMoment {
    double time = 0; ///< seconds since the storm began
    StormEvent event{};
    int viewer = 0; ///< to which it happens; of the others the number of the event
    double seconds = 0; ///< that somebody stays
    double chance = 0; ///< [0, 1): for whatever else is left to chance
    bool operator==(StormMoment const&) const = default;
};

struct StormParameters {
    int viewers = 8; ///< > 0
    double seconds = 6;
    double viewer_events_per_second = 0.5; ///< mean, of each viewer
    double visits_per_second = 2; ///< mean
    std::uint64_t seed = 1;
};

/// Times of arrival are those of a Poisson process. Nobody stays beyond the end.
std::vector<StormMoment> make_storm(StormParameters const& parameters);

} // namespace framelet::bench
