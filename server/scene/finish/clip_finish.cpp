#include <algorithm>

#include "common/counted.h"
#include "common/error.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/motion/animation.h"

namespace framelet {
namespace {

/// Drops keys whose time does not increase.
std::size_t drop_repeated_keys(AnimationChannel& channel) {
    std::size_t const width = channel.values.size() / channel.times.size();
    std::size_t kept = 0;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        if (kept == 0 || channel.times[key] > channel.times[kept - 1]) {
            channel.times[kept] = channel.times[key];
            std::copy_n(channel.values.begin() + static_cast<std::ptrdiff_t>(key * width), width,
                        channel.values.begin() + static_cast<std::ptrdiff_t>(kept * width));
            ++kept;
        }
    }
    std::size_t const dropped = channel.times.size() - kept;
    channel.times.resize(kept);
    channel.values.resize(kept * width);
    return dropped;
}

/// True where the channel can be played.
bool finish_channel(Scene& scene, AnimationClip const& clip, AnimationChannel& channel) {
    Node& node = scene.nodes[static_cast<std::size_t>(channel.node)];
    std::string const what = "animation '" + clip.name + "'";
    auto const finite = [](float value) { return in_range(value); };
    if (!std::all_of(channel.times.begin(), channel.times.end(), finite) ||
        !std::all_of(channel.values.begin(), channel.values.end(), finite)) {
        scene.warnings.push_back(what + " has keys that are not numbers; what they move stands still");
        return false;
    }
    if (std::size_t const dropped = drop_repeated_keys(channel)) {
        scene.warnings.push_back(what + ": " + counted(dropped, "key") +
                                 " dropped, with a time that does not increase");
    }
    if (channel.property == AnimatedProperty::morph_weights) {
        std::size_t const targets =
            node.mesh == none ? 0 : scene.meshes[static_cast<std::size_t>(node.mesh)].morph_weights.size();
        if (targets != static_cast<std::size_t>(channel.components)) {
            scene.warnings.push_back(what + " has " + counted(static_cast<std::size_t>(channel.components), "weight") +
                                     " for " + counted(targets, "morph target") + "; passed over");
            return false;
        }
    } else if (node.matrix) {
        node.local = transform_of(*node.matrix);
        node.matrix.reset();
    }
    return true;
}

} // namespace

void finish_clips(Scene& scene) {
    for (AnimationClip& clip : scene.clips) {
        std::erase_if(clip.channels, [&](AnimationChannel& channel) { return !finish_channel(scene, clip, channel); });
        clip.duration = 0;
        for (AnimationChannel const& channel : clip.channels) {
            clip.duration = std::max(clip.duration, channel.times.back());
        }
    }
    std::erase_if(scene.clips, [](AnimationClip const& clip) { return clip.channels.empty(); });
}

} // namespace framelet
