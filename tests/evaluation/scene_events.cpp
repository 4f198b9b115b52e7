#include "tests/evaluation/scene_events.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Scene times from which on nothing changes for 0.75 s; one after the other, each is unlike the one before.
std::vector<double> rests_of(std::string_view name) {
    return name == "flicker"    ? std::vector<double>{2, 0}
           : name == "teleport" ? std::vector<double>{1, 2, 3, 4, 5, 0}
                                : std::vector<double>{};
}

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

std::size_t settings_made(std::vector<ClockSetting> const& settings, double when) {
    return static_cast<std::size_t>(std::ranges::upper_bound(settings, when, {}, &ClockSetting::when) -
                                    settings.begin());
}

double clock_at(std::vector<ClockSetting> const& settings, double start, double now, double late) {
    std::size_t const made = settings_made(settings, now - late);
    return made == 0 ? start + now : settings[made - 1].time + now - settings[made - 1].when;
}

std::vector<ClockSetting> unannounced_settings(std::string const& name, double duration, double seconds) {
    constexpr double first = 0.26, period = 0.5; // seconds; just after a measurement, at 20 a second
    constexpr double golden_ratio = 0.6180339887;
    std::vector<double> const rests = rests_of(name);
    std::vector<ClockSetting> settings;
    for (double when = first; when < seconds; when += period) {
        std::size_t const i = settings.size();
        double const share = std::fmod(golden_ratio * static_cast<double>(i + 1), 1.0);
        settings.push_back({when, rests.empty() ? share * std::max(duration - period, 0.0) : rests[i % rests.size()]});
    }
    return settings;
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
