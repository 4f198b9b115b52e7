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

/// Adds the short ways between two long stays.
void add_baked_switches(AnimationChannel const& channel, float duration, bool is_seen,
                        std::vector<SceneSwitch>& switches) {
    constexpr float longest_way = 0.05f, shortest_stay = 0.2f; // seconds; frames are a 24th of a second or shorter
    Comparison comparison;
    std::vector<float> const& times = channel.times;
    float stays_since = -shortest_stay; // what is before the first key is as there
    std::optional<SceneSwitch> open; // one that is a jump if what comes after it stays
    for (std::size_t i = 1; i < times.size() && times[i] < duration; ++i) {
        if (!comparison.jumps(channel, times[i - 1], times[i])) {
            continue;
        }
        bool const stayed = times[i - 1] - stays_since >= shortest_stay;
        if (open && stayed) {
            switches.push_back(*open);
        }
        open.reset();
        if (stayed && times[i] - times[i - 1] <= longest_way) {
            double const middle = 0.5 * (times[i - 1] + times[i]);
            open = {middle, is_seen, times[i] - middle};
        }
        stays_since = times[i];
    }
    if (open) {
        switches.push_back(*open);
    }
}

/// Nodes, and all their ancestors.
class MarkedNodes {
public:
    explicit MarkedNodes(Scene const& scene) : scene_(scene), marked_(scene.nodes.size()) {}

    void mark(Index node) {
        for (; node != none && !is_marked(node); node = scene_.nodes[static_cast<std::size_t>(node)].parent) {
            marked_[static_cast<std::size_t>(node)] = true;
        }
    }
    bool is_marked(Index node) const { return marked_[static_cast<std::size_t>(node)]; }

private:
    Scene const& scene_;
    std::vector<bool> marked_;
};

/// Nodes of meshes, of lights and of joints.
MarkedNodes seen_nodes(Scene const& scene) {
    MarkedNodes seen(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh != none) {
            seen.mark(static_cast<Index>(i));
        }
    }
    for (Light const& light : scene.lights) {
        seen.mark(light.node);
    }
    for (Skin const& skin : scene.skins) {
        std::ranges::for_each(skin.joints, [&](Index joint) { seen.mark(joint); });
    }
    return seen;
}

/// Nodes of lights and cameras: all of the picture depends on where these are.
MarkedNodes governing_nodes(Scene const& scene) {
    MarkedNodes governing(scene);
    for (Light const& light : scene.lights) {
        governing.mark(light.node);
    }
    for (SceneCamera const& camera : scene.cameras) {
        governing.mark(camera.node);
    }
    return governing;
}

void add_switches(AnimationChannel const& channel, float duration, bool is_seen, bool governs,
                  std::vector<SceneSwitch>& switches) {
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
    } else if (channel.interpolation == Interpolation::linear && governs) {
        add_baked_switches(channel, duration, is_seen, switches);
    }
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
    MarkedNodes const seen = seen_nodes(scene), governing = governing_nodes(scene);
    std::vector<ClipSwitches> out;
    for (Index const index : clips) {
        AnimationClip const& clip = scene.clips[static_cast<std::size_t>(index)];
        if (!(clip.duration > 0)) {
            continue;
        }
        ClipSwitches found{clip.duration, {}};
        for (AnimationChannel const& channel : clip.channels) {
            add_switches(channel, clip.duration, seen.is_marked(channel.node), governing.is_marked(channel.node),
                         found.switches);
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
                    first = first ? SceneSwitch{std::min(first->time, at), jump.is_seen || first->is_seen,
                                                std::max(first->settling, jump.settling)}
                                  : SceneSwitch{at, jump.is_seen, jump.settling};
                }
            }
        }
    }
    return {first.has_value(), first && last - first->time < together ? first : std::nullopt};
}

} // namespace framelet
