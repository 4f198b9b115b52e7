#include "server/scene/switches.h"

#include <algorithm>
#include <cmath>

#include "server/scene/keyframes.h"

namespace framelet {
namespace {

/// A quaternion and its negative turn alike.
bool is_same(AnimationChannel const& channel, std::span<float const> a, std::span<float const> b) {
    constexpr float rounding = 1e-4f;
    auto const is_near = [&](float sign) {
        return std::ranges::equal(a, b, [&](float x, float y) {
            return std::abs(x - sign * y) <= rounding * std::max({1.0f, std::abs(x), std::abs(y)});
        });
    };
    return is_near(1) || (channel.property == AnimatedProperty::rotation && is_near(-1));
}

/// Scratch for two values of a channel.
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

void add_switches(AnimationChannel const& channel, float duration, std::vector<double>& times) {
    Comparison comparison;
    if (comparison.jumps(channel, duration, 0)) {
        times.push_back(0);
    }
    if (channel.interpolation == Interpolation::step) {
        for (std::size_t i = 1; i < channel.times.size() && channel.times[i] < duration; ++i) {
            if (comparison.jumps(channel, channel.times[i - 1], channel.times[i])) {
                times.push_back(channel.times[i]);
            }
        }
    }
}

} // namespace

std::vector<ClipSwitches> find_switches(Scene const& scene, std::span<Index const> clips) {
    std::vector<ClipSwitches> out;
    for (Index const index : clips) {
        AnimationClip const& clip = scene.clips[static_cast<std::size_t>(index)];
        if (!(clip.duration > 0)) {
            continue;
        }
        ClipSwitches found{clip.duration, {}};
        for (AnimationChannel const& channel : clip.channels) {
            add_switches(channel, clip.duration, found.times);
        }
        std::ranges::sort(found.times);
        auto const doubles = std::ranges::unique(found.times);
        found.times.erase(doubles.begin(), doubles.end());
        if (!found.times.empty()) {
            out.push_back(std::move(found));
        }
    }
    return out;
}

std::optional<SceneTime> lone_switch(std::span<ClipSwitches const> clips, SceneTime from, SceneTime to) {
    constexpr double together = 1e-3;
    std::optional<SceneTime> first, last;
    for (ClipSwitches const& clip : clips) {
        double const turn = std::floor(from / clip.duration) * clip.duration;
        if (to - from >= clip.duration) {
            return std::nullopt; // it comes round more than once
        }
        for (double const begun : {turn, turn + clip.duration}) {
            for (double const time : clip.times) {
                double const at = begun + time;
                if (at > from && at <= to) {
                    first = std::min(first.value_or(at), at);
                    last = std::max(last.value_or(at), at);
                }
            }
        }
    }
    return first && *last - *first < together ? first : std::nullopt;
}

} // namespace framelet
