#include "server/scene/motion/switches.h"

#include <algorithm>
#include <cmath>

#include "server/scene/motion/keyframes.h"

namespace framelet {
namespace {

/// True where two values are equal but for rounding. A quaternion and its negative turn alike.
bool is_same(AnimationChannel const& channel, std::span<float const> a, std::span<float const> b) {
    constexpr float rounding = 1e-4f;
    auto const is_near = [&](float sign) {
        return std::ranges::equal(a, b, [&](float x, float y) {
            return std::abs(x - sign * y) <= rounding * std::max({1.0f, std::abs(x), std::abs(y)});
        });
    };
    return is_near(1) || (channel.property == AnimatedProperty::rotation && is_near(-1));
}

/// Compares two values of a channel; keeps its scratch.
class Comparison {
public:
    bool jumps(AnimationChannel const& channel, float before, float after) {
        auto const size = static_cast<std::size_t>(channel.components);
        before_.resize(size);
        after_.resize(size);
        sample_channel(channel, before, before_);
        sample_channel(channel, after, after_);
        return !is_same(channel, before_, after_);
    }

private:
    std::vector<float> before_, after_;
};

void add_switches(AnimationChannel const& channel, float duration, bool is_seen, std::vector<SceneSwitch>& switches) {
    Comparison comparison;
    if (comparison.jumps(channel, duration, 0)) {
        switches.push_back({0, is_seen});
    }
    if (channel.interpolation == Interpolation::step) {
        for (std::size_t i = 1; i < channel.times.size() && channel.times[i] < duration; ++i) {
            if (comparison.jumps(channel, channel.times[i - 1], channel.times[i])) {
                switches.push_back({channel.times[i], is_seen});
            }
        }
    }
}

/// True for the nodes of meshes, of lights and of joints, and for all their ancestors.
std::vector<bool> seen_nodes(Scene const& scene) {
    std::vector<bool> seen(scene.nodes.size());
    auto const mark = [&](Index node) {
        if (node != none) {
            seen[static_cast<std::size_t>(node)] = true;
        }
    };
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        seen[i] = scene.nodes[i].mesh != none;
    }
    for (Light const& light : scene.lights) {
        mark(light.node);
    }
    for (Skin const& skin : scene.skins) {
        std::ranges::for_each(skin.joints, mark);
    }
    for (std::size_t i = scene.nodes.size(); i-- > 0;) {
        if (seen[i]) {
            mark(scene.nodes[i].parent);
        }
    }
    return seen;
}

/// Sorts switches by time; of those of one time one is kept, a seen one if there is any.
void sort(std::vector<SceneSwitch>& switches) {
    std::ranges::sort(switches, [](SceneSwitch const& a, SceneSwitch const& b) {
        return a.time != b.time ? a.time < b.time : a.is_seen && !b.is_seen;
    });
    auto const is_double = [](SceneSwitch const& a, SceneSwitch const& b) { return a.time == b.time; };
    switches.erase(std::unique(switches.begin(), switches.end(), is_double), switches.end());
}

} // namespace

std::vector<ClipSwitches> find_switches(Scene const& scene, std::span<Index const> clips) {
    std::vector<bool> const seen = seen_nodes(scene);
    std::vector<ClipSwitches> out;
    for (Index const index : clips) {
        AnimationClip const& clip = scene.clips[static_cast<std::size_t>(index)];
        if (!(clip.duration > 0)) {
            continue;
        }
        ClipSwitches found{clip.duration, {}};
        for (AnimationChannel const& channel : clip.channels) {
            add_switches(channel, clip.duration, seen[static_cast<std::size_t>(channel.node)], found.switches);
        }
        sort(found.switches);
        if (!found.switches.empty()) {
            out.push_back(std::move(found));
        }
    }
    return out;
}

Switches switches_within(std::span<ClipSwitches const> clips, SceneTime from, SceneTime to) {
    constexpr double together = 1e-3;
    std::optional<SceneSwitch> first;
    SceneTime last = 0;
    for (ClipSwitches const& clip : clips) {
        double const turn = std::floor(from / clip.duration) * clip.duration;
        if (to - from >= clip.duration) {
            return {true, std::nullopt}; // it comes round more than once
        }
        for (double const begun : {turn, turn + clip.duration}) {
            for (SceneSwitch const& jump : clip.switches) {
                double const at = begun + jump.time;
                if (at > from && at <= to) {
                    last = first ? std::max(last, at) : at;
                    first = {first ? std::min(first->time, at) : at, jump.is_seen || (first && first->is_seen)};
                }
            }
        }
    }
    return {first.has_value(), first && last - first->time < together ? first : std::nullopt};
}

} // namespace framelet
