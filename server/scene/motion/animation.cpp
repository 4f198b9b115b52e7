#include "server/scene/motion/animation.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "common/error.h"
#include "server/scene/motion/keyframes.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

/// Seconds into a clip that loops.
float clip_time(AnimationClip const& clip, SceneTime time) {
    double const duration = clip.duration;
    if (!(duration > 0)) {
        return 0;
    }
    double const wrapped = std::fmod(time, duration);
    return static_cast<float>(wrapped < 0 ? wrapped + duration : wrapped);
}

/// The transform itself; where keys take a node so far that a float cannot tell, one that shrinks it to nothing.
glm::dmat4 usable(glm::dmat4 const& world) {
    constexpr double farthest = 1e15;
    for (int column = 0; column < 4; ++column) {
        glm::dvec4 const& v = world[column];
        if (!(std::abs(v.x) + std::abs(v.y) + std::abs(v.z) <= farthest)) {
            glm::dmat4 nothing(0);
            nothing[3].w = 1;
            return nothing;
        }
    }
    return world;
}

void apply_channel(AnimationChannel const& channel, float seconds, Transform& local, std::vector<float>& weights) {
    if (channel.property == AnimatedProperty::morph_weights) {
        weights.resize(static_cast<std::size_t>(channel.components));
        sample_channel(channel, seconds, weights);
        return;
    }
    std::array<float, 4> v{};
    sample_channel(channel, seconds, std::span(v).first(static_cast<std::size_t>(channel.components)));
    switch (channel.property) {
    case AnimatedProperty::translation:
        local.translation = Vec3(v[0], v[1], v[2]);
        break;
    case AnimatedProperty::scale:
        local.scale = Vec3(v[0], v[1], v[2]);
        break;
    default:
        local.rotation = Quat(v[3], v[0], v[1], v[2]);
    }
}

/// True when the channel holds the node at its own transform: many exporters write such for every node.
bool changes_nothing(Node const& node, AnimationChannel const& channel) {
    auto const n = static_cast<std::size_t>(channel.components);
    Transform const& local = node.local;
    std::array<float, 4> const own =
        channel.property == AnimatedProperty::rotation
            ? std::array{local.rotation.x, local.rotation.y, local.rotation.z, local.rotation.w}
        : channel.property == AnimatedProperty::scale
            ? std::array{local.scale.x, local.scale.y, local.scale.z, 0.0f}
            : std::array{static_cast<float>(local.translation.x), static_cast<float>(local.translation.y),
                         static_cast<float>(local.translation.z), 0.0f};
    if (channel.interpolation == Interpolation::cubic_spline) {
        return false;
    }
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
        if (channel.values[i] != own[i % n]) {
            return false;
        }
    }
    return true;
}

} // namespace

glm::dmat4 matrix_of(Transform const& transform) {
    glm::dmat4 matrix = glm::mat4_cast(glm::dquat(transform.rotation));
    matrix[0] *= transform.scale.x;
    matrix[1] *= transform.scale.y;
    matrix[2] *= transform.scale.z;
    matrix[3] = glm::dvec4(transform.translation, 1);
    return matrix;
}

Transform transform_of(glm::dmat4 const& matrix) {
    Transform result;
    result.translation = glm::dvec3(matrix[3]);
    Mat3 axes(matrix);
    for (int c = 0; c < 3; ++c) {
        result.scale[c] = glm::length(axes[c]);
        axes[c] = unit_or(axes[c], Vec3(0));
    }
    if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0) {
        result.scale.x = -result.scale.x;
        axes[0] = -axes[0];
    }
    result.rotation = unit_rotation(glm::quat_cast(axes));
    return result;
}

std::vector<Index> default_clips(Scene const& scene) {
    std::vector<bool> taken(scene.nodes.size());
    std::vector<Index> clips;
    for (std::size_t i = 0; i < scene.clips.size(); ++i) {
        auto const& channels = scene.clips[i].channels;
        bool const free = std::none_of(channels.begin(), channels.end(), [&](AnimationChannel const& channel) {
            return taken[static_cast<std::size_t>(channel.node)];
        });
        if (free) {
            clips.push_back(static_cast<Index>(i));
            for (AnimationChannel const& channel : channels) {
                taken[static_cast<std::size_t>(channel.node)] = true;
            }
        }
    }
    return clips;
}

std::vector<Index> clips_named(Scene const& scene, std::span<std::string const> names) {
    std::vector<Index> chosen;
    for (std::string const& name : names) {
        Index found = none;
        std::string known;
        for (std::size_t i = 0; i < scene.clips.size(); ++i) {
            found = scene.clips[i].name == name ? static_cast<Index>(i) : found;
            known += (i > 0 ? ", " : "") + scene.clips[i].name;
        }
        if (found == none) {
            throw InputError("the scene has no clip '" + name +
                             "': " + (known.empty() ? "nothing in it is animated" : "its clips are " + known));
        }
        chosen.push_back(found);
    }
    return chosen;
}

PoseEvaluator::PoseEvaluator(Scene const& scene, std::span<Index const> clips)
    : scene_(scene), clips_(clips), locals_(scene.nodes.size()), placed_(scene.nodes.size()) {
    std::size_t const count = scene.nodes.size();
    std::vector<std::uint8_t> moves(count);
    for (Index const clip : clips) {
        for (AnimationChannel const& channel : scene.clips[static_cast<std::size_t>(clip)].channels) {
            moves[static_cast<std::size_t>(channel.node)] = 1;
        }
    }
    pose_.world_from_node.resize(count);
    pose_.morph_weights.resize(count);
    for (std::size_t i = 0; i < count; ++i) { // parents come first
        if (moves[i] != 0) {
            animated_.push_back(i);
        }
        Index const parent = scene.nodes[i].parent;
        moves[i] |= parent != none ? moves[static_cast<std::size_t>(parent)] : std::uint8_t{0};
        if (moves[i] != 0) {
            moving_.push_back(i);
        }
        rest(i);
        place(i);
    }
}

/// Sets what is a node's own to what it is without clips.
void PoseEvaluator::rest(std::size_t i) {
    Node const& node = scene_.nodes[i];
    locals_[i] = node.local;
    if (node.mesh != none) {
        pose_.morph_weights[i] = node.morph_weights.empty()
                                     ? scene_.meshes[static_cast<std::size_t>(node.mesh)].morph_weights
                                     : node.morph_weights;
    }
}

void PoseEvaluator::place(std::size_t i) {
    Node const& node = scene_.nodes[i];
    glm::dmat4 const local = node.matrix ? *node.matrix : matrix_of(locals_[i]);
    placed_[i] = usable(node.parent == none ? local : placed_[static_cast<std::size_t>(node.parent)] * local);
    glm::dmat4 world = placed_[i];
    world[3] -= glm::dvec4(scene_.origin, 0);
    pose_.world_from_node[i] = Mat4(world);
}

ScenePose const& PoseEvaluator::at(SceneTime time) {
    pose_.time = NAN; // until all is there
    std::ranges::for_each(animated_, [this](std::size_t i) { rest(i); });
    for (Index const clip_index : clips_) {
        AnimationClip const& clip = scene_.clips[static_cast<std::size_t>(clip_index)];
        float const seconds = clip_time(clip, time);
        for (AnimationChannel const& channel : clip.channels) {
            auto const node = static_cast<std::size_t>(channel.node);
            apply_channel(channel, seconds, locals_[node], pose_.morph_weights[node]);
        }
    }
    std::ranges::for_each(moving_, [this](std::size_t i) { place(i); });
    pose_.time = time;
    return pose_;
}

ScenePose evaluate_pose(Scene const& scene, std::span<Index const> clips, SceneTime time) {
    return PoseEvaluator(scene, clips).at(time);
}

std::vector<bool> animated_nodes(Scene const& scene, std::span<Index const> clips) {
    std::vector<bool> animated(scene.nodes.size());
    for (Index const clip : clips) {
        for (AnimationChannel const& channel : scene.clips[static_cast<std::size_t>(clip)].channels) {
            auto const node = static_cast<std::size_t>(channel.node);
            if (channel.property != AnimatedProperty::morph_weights && !changes_nothing(scene.nodes[node], channel)) {
                animated[node] = true;
            }
        }
    }
    return animated;
}

std::vector<bool> moving_nodes(Scene const& scene, std::span<Index const> clips) {
    std::vector<bool> moving = animated_nodes(scene, clips);
    for (std::size_t i = 0; i < moving.size(); ++i) { // parents come first
        Index const parent = scene.nodes[i].parent;
        moving[i] = moving[i] || (parent != none && moving[static_cast<std::size_t>(parent)]);
    }
    return moving;
}

double animation_duration(Scene const& scene, std::span<Index const> clips) {
    double longest = 0;
    for (Index const clip : clips) {
        longest = std::max<double>(longest, scene.clips[static_cast<std::size_t>(clip)].duration);
    }
    return longest;
}

} // namespace framelet
