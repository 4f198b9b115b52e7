// Draws the events that happen to a server and its viewers in a storm. In: how many viewers, how long, a seed. Out:
// events in the order of their times; the same in, the same out, so that a storm that found something can be repeated.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace framelet::bench {

enum class StormEvent : std::uint8_t {
    // Events of one of the viewers that stay:
    resize, ///< the viewer's picture gets another size
    cut, ///< the viewer's connection ends amid whatever is on its way; it comes back by itself
    settings, ///< the viewer wants another exposure, or moves nothing
    clock, ///< the viewer asks for another time of the scene, to play, or to pause
    // Events of a stranger, who comes for it and goes:
    killed_program, ///< a framelet-client comes and is killed at the end
    stopped_program, ///< the same, but it is stopped for the latter half of the time: to the server it reads nothing
    slow_reader, ///< a viewer asks for a large picture and reads nothing of it
    half_message, ///< a viewer's connection ends amid a message
    garbage, ///< a connection sends what is no message
    rush, ///< many viewers say hello, ask for a picture and are gone, one after the other
};
inline constexpr int storm_event_kinds = 10;

/// Name of the event in tables.
std::string_view name_of(StormEvent event);
/// True if the event happens to one of the viewers that stay.
constexpr bool is_of_viewer(StormEvent event) {
    return event <= StormEvent::clock;
}

struct StormMoment {
    double time = 0; ///< seconds since the storm began
    StormEvent event{};
    int viewer = 0; ///< viewer to which it happens; for strangers the number of the event
    double seconds = 0; ///< seconds that a stranger stays
    double chance = 0; ///< random number in [0, 1) for whatever else is left to chance
    bool operator==(StormMoment const&) const = default;
};

struct StormParameters {
    int viewers = 8; ///< > 0
    double seconds = 6;
    double viewer_events_per_second = 0.5; ///< mean number of events of each viewer, a second
    double visits_per_second = 2; ///< mean number of strangers that come, a second
    std::uint64_t seed = 1;
};

/// Draws a storm. Times of arrival are those of a Poisson process. No stranger stays beyond the end.
std::vector<StormMoment> make_storm(StormParameters const& parameters);

} // namespace framelet::bench
