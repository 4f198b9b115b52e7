#include "tests/evaluation/scene_events.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/error.h"
#include "scenes/scene_table.h"

namespace framelet::bench {
namespace {

/// Scene times at which a vehicle is before the camera, which no track of the document tells.
constexpr std::array<std::pair<std::string_view, double>, 3> passings{
    {{"vehicle_flyby", 2.6}, {"vehicle_approach", 4}, {"vehicle_crossing", 0.75}}};
/// Scene time at which the car has left the picture, and nothing is seen to move from then on.
constexpr std::pair<std::string_view, double> leaving{"vehicle_fixed", 3.3};

SceneEntry const* find_scene(std::string const& name) {
    auto const found = std::ranges::find(scene_table(), name, &SceneEntry::name);
    return found == scene_table().end() ? nullptr : &*found;
}

} // namespace

SceneEvents events_of(GltfDocument const& document, double duration) {
    SceneEvents result;
    double last_motion = 0;
    for (GltfTrack const& track : document.tracks) {
        for (std::size_t key = 1; key < track.values.size(); ++key) {
            if (track.values[key] == track.values[key - 1]) {
                continue;
            }
            if (track.step) {
                result.times.push_back(track.times[key]);
            } else {
                result.motions.emplace_back(track.times[key - 1], track.times[key]);
                last_motion = std::max(last_motion, track.times[key]);
            }
        }
    }
    result.times.push_back(last_motion);
    std::erase_if(result.times, [duration](double time) { return time <= 0 || time >= duration - 1e-6; });
    std::ranges::sort(result.times);
    auto const same = [](double a, double b) { return b - a < 1e-6; };
    result.times.erase(std::unique(result.times.begin(), result.times.end(), same), result.times.end());
    return result;
}

SceneEvents events_of(std::string const& name) {
    SceneEntry const* const entry = find_scene(name);
    if (entry == nullptr) {
        throw InputError("the scene generator has no scene '" + name + "'");
    }
    SceneEvents events = events_of(entry->make(), entry->duration);
    if (name == leaving.first) {
        events.times.push_back(leaving.second);
        for (auto& [from, until] : events.motions) {
            until = std::min(until, leaving.second);
        }
    }
    return events;
}

Phase phase_at(SceneEvents const& events, double time) {
    auto const since = [time](double event) { return time >= event && time < event + event_seconds; };
    if (std::ranges::any_of(events.times, since)) {
        return Phase::event;
    }
    auto const within = [time](auto const& motion) { return time >= motion.first && time < motion.second; };
    return std::ranges::any_of(events.motions, within) ? Phase::moving : Phase::settled;
}

double window_start(std::string const& name, double seconds) {
    SceneEntry const* const entry = find_scene(name);
    if (entry == nullptr) {
        return 0;
    }
    auto const passing = std::ranges::find(passings, name, [](auto const& one) { return one.first; });
    std::vector<double> const events = events_of(name).times;
    double const middle = passing != passings.end() ? passing->second
                          : !events.empty()         ? events.front()
                                                    : 0.5 * entry->duration;
    return std::clamp(middle - 0.5 * seconds, 0.0, std::max(entry->duration - seconds, 0.0));
}

} // namespace framelet::bench
