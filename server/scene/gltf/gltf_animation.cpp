#include <tiny_gltf.h>

#include "common/error.h"
#include "server/scene/gltf/gltf_accessor.h"
#include "server/scene/gltf/gltf_parts.h"

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

std::vector<float> flatten(GltfAccessors const& accessors, int accessor, int components) {
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

AnimationChannel import_channel(GltfAccessors const& accessors, tinygltf::AnimationSampler const& sampler,
                                AnimationChannel channel) {
    channel.interpolation = sampler.interpolation == "STEP"          ? Interpolation::step
                            : sampler.interpolation == "CUBICSPLINE" ? Interpolation::cubic_spline
                                                                     : Interpolation::linear;
    channel.times = accessors.read<float>(sampler.input);
    std::size_t const keys = channel.times.size() * (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
    if (channel.property == AnimatedProperty::morph_weights) {
        channel.values = accessors.read<float>(sampler.output);
        channel.components = keys == 0 ? 1 : static_cast<int>(channel.values.size() / keys);
    } else {
        channel.values = flatten(accessors, sampler.output, channel.components);
    }
    if (keys == 0 || channel.components < 1 ||
        channel.values.size() != keys * static_cast<std::size_t>(channel.components)) {
        throw InputError(std::to_string(channel.values.size()) + " values do not fit " +
                         std::to_string(channel.times.size()) + " keys");
    }
    return channel;
}

} // namespace

void import_gltf_animations(tinygltf::Model const& model, GltfAccessors const& accessors,
                            std::vector<Index> const& node_of, Scene& scene) {
    for (std::size_t i = 0; i < model.animations.size(); ++i) {
        tinygltf::Animation const& from = model.animations[i];
        AnimationClip clip;
        clip.name = from.name.empty() ? "clip " + std::to_string(i + 1) : from.name;
        for (tinygltf::AnimationChannel const& target : from.channels) {
            AnimationChannel channel;
            bool const node_exists =
                target.target_node >= 0 && static_cast<std::size_t>(target.target_node) < node_of.size();
            channel.node = node_exists ? node_of[static_cast<std::size_t>(target.target_node)] : none;
            if (!find_property(target.target_path, channel)) {
                scene.warnings.push_back("animation '" + clip.name + "': '" + target.target_path + "' is not animated");
            } else if (target.sampler < 0 || static_cast<std::size_t>(target.sampler) >= from.samplers.size()) {
                throw InputError("animation '" + clip.name + "': sampler " + std::to_string(target.sampler) +
                                 " does not exist");
            } else if (channel.node != none) {
                try {
                    clip.channels.push_back(
                        import_channel(accessors, from.samplers[static_cast<std::size_t>(target.sampler)], channel));
                } catch (InputError const& error) {
                    throw InputError("animation '" + clip.name + "': " + error.what());
                }
            }
        }
        scene.clips.push_back(std::move(clip));
    }
}

} // namespace framelet
