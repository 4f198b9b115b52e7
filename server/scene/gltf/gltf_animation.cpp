#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_parts.h"
#include "server/scene/reading/faults.h"

namespace framelet {
namespace {

/// Sets property and components of the channel by the file's target path; false for paths that the scene does not know.
bool find_property(std::string const& path, AnimationChannel& channel) {
    if (path == "translation" || path == "scale") {
        channel.property = path == "scale" ? AnimatedProperty::scale : AnimatedProperty::translation;
        channel.components = 3;
    } else if (path == "rotation") {
        channel.property = AnimatedProperty::rotation;
        channel.components = 4;
    } else if (path == "weights") {
        channel.property = AnimatedProperty::morph_weights;
    } else {
        return false;
    }
    return true;
}

std::vector<float> flatten(GltfAccessors const& accessors, Index accessor, int components) {
    std::vector<float> values;
    if (components == 3) {
        for (Vec3 const& v : accessors.read<Vec3>(accessor)) {
            values.insert(values.end(), {v.x, v.y, v.z});
        }
    } else {
        for (Vec4 const& v : accessors.read<Vec4>(accessor)) {
            values.insert(values.end(), {v.x, v.y, v.z, v.w});
        }
    }
    return values;
}

AnimationChannel import_channel(GltfAccessors const& accessors, Json const& sampler, AnimationChannel channel) {
    std::string const interpolation = text(sampler, "interpolation");
    channel.interpolation = interpolation == "STEP"          ? Interpolation::step
                            : interpolation == "CUBICSPLINE" ? Interpolation::cubic_spline
                                                             : Interpolation::linear;
    channel.times = accessors.read<float>(index(sampler, "input"));
    std::size_t const keys = channel.times.size() * (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
    if (channel.property == AnimatedProperty::morph_weights) {
        channel.values = accessors.read<float>(index(sampler, "output"));
        channel.components = keys == 0 ? 1 : static_cast<int>(channel.values.size() / keys);
    } else {
        channel.values = flatten(accessors, index(sampler, "output"), channel.components);
    }
    if (keys == 0 || channel.components < 1 ||
        channel.values.size() != keys * static_cast<std::size_t>(channel.components)) {
        throw InputError(std::to_string(channel.values.size()) + " values do not fit " +
                         std::to_string(channel.times.size()) + " keys");
    }
    return channel;
}

} // namespace

void import_gltf_animations(Json const& json, GltfAccessors const& accessors, std::vector<Index> const& node_of,
                            Scene& scene, std::vector<std::string>& faults) {
    Json::array_t const& animations = list(json, "animations");
    for (std::size_t i = 0; i < animations.size(); ++i) {
        AnimationClip clip;
        clip.name = text(animations[i], "name");
        if (clip.name.empty()) {
            clip.name = "clip " + std::to_string(i + 1);
        }
        Faults const of_clip("animation '" + clip.name + "'", faults);
        Json::array_t const& samplers = list(animations[i], "samplers");
        for (Json const& from : list(animations[i], "channels")) {
            Json const& target = member(from, "target");
            Index const node = index(target, "node");
            AnimationChannel channel;
            channel.node = node >= 0 && static_cast<std::size_t>(node) < node_of.size()
                               ? node_of[static_cast<std::size_t>(node)]
                               : none;
            std::string const path = text(target, "path");
            if (path == "pointer") {
                continue; // of KHR_animation_pointer, which has been noted
            }
            if (!find_property(path, channel)) {
                scene.warnings.push_back("animation '" + clip.name + "': '" + path + "' is not animated");
            } else if (channel.node != none) {
                of_clip.tried(
                    [&] {
                        std::size_t const sampler = checked(member(from, "sampler"), samplers.size(), "sampler");
                        clip.channels.push_back(import_channel(accessors, samplers[sampler], channel));
                    },
                    "; what it moves there stands still");
            }
        }
        scene.clips.push_back(std::move(clip));
    }
}

} // namespace framelet
