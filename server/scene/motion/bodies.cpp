#include "server/scene/motion/bodies.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// Scales that differ by less than this, relatively, are one.
constexpr float scale_tolerance = 1e-4f;

bool alike(float a, float b) {
    return std::abs(a - b) <= scale_tolerance * std::max(std::abs(a), std::abs(b));
}

/// True for a rotation times one scale, mirrored or not: what stands below may turn without being sheared.
bool keeps_angles(Node const& node) {
    if (!node.matrix) {
        Vec3 const size = glm::abs(node.local.scale);
        return alike(size.x, size.y) && alike(size.y, size.z);
    }
    Mat3 const m(*node.matrix);
    float const x = glm::dot(m[0], m[0]), y = glm::dot(m[1], m[1]), z = glm::dot(m[2], m[2]);
    float const skew =
        std::max({std::abs(glm::dot(m[0], m[1])), std::abs(glm::dot(m[1], m[2])), std::abs(glm::dot(m[2], m[0]))});
    return alike(x, y) && alike(y, z) && skew <= scale_tolerance * x;
}

/// True when every key of an animated scale, tangents included, is the same along the three axes.
bool keeps_angles(AnimationChannel const& channel) {
    for (std::size_t i = 0; i + 2 < channel.values.size(); i += 3) {
        float const x = channel.values[i], y = channel.values[i + 1], z = channel.values[i + 2];
        if (!alike(x, y) || !alike(y, z)) {
            return false;
        }
    }
    return true;
}

/// Effects of the clips on each node, by its own channels.
struct NodeMotion {
    std::vector<bool> moves, keeps_angles, morphs;
};

NodeMotion node_motion(Scene const& scene, std::span<Index const> clips) {
    NodeMotion motion{animated_nodes(scene, clips), std::vector<bool>(scene.nodes.size()),
                      std::vector<bool>(scene.nodes.size())};
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        motion.keeps_angles[i] = keeps_angles(scene.nodes[i]);
    }
    for (Index const clip : clips) {
        for (AnimationChannel const& channel : scene.clips[static_cast<std::size_t>(clip)].channels) {
            auto const node = static_cast<std::size_t>(channel.node);
            if (channel.property == AnimatedProperty::morph_weights) {
                motion.morphs[node] = true;
            } else if (channel.property == AnimatedProperty::scale) {
                motion.keeps_angles[node] = keeps_angles(channel);
            }
        }
    }
    return motion;
}

} // namespace

bool SceneBodies::any_flows() const {
    return std::ranges::find(flows, true) != flows.end();
}

std::size_t joint_of(Primitive const& primitive, std::array<std::uint32_t, 3> const& triangle) {
    std::size_t best = 0;
    float most = -1;
    for (std::uint32_t const corner : triangle) {
        std::uint16_t const joint = primitive.influences[corner].joints[0]; // the strongest come first
        float sum = 0;
        for (std::uint32_t const vertex : triangle) {
            JointInfluence const& influence = primitive.influences[vertex];
            for (std::size_t k = 0; k < influence.joints.size(); ++k) {
                sum += influence.joints[k] == joint ? influence.weights[k] : 0;
            }
        }
        if (sum > most) {
            most = sum;
            best = joint;
        }
    }
    return best;
}

SceneBodies find_bodies(Scene const& scene, std::span<Index const> clips) {
    std::size_t const count = scene.nodes.size();
    NodeMotion const motion = node_motion(scene, clips);
    std::vector<bool> const moving = moving_nodes(scene, clips);
    SceneBodies bodies;
    bodies.body_of_node.assign(count, static_body);
    bodies.flows.assign(count, false);
    std::vector<Index> frame(count, none); // nearest node that the clips move
    std::vector<bool> rigid_above(count, true); // nothing above it shears what turns below
    std::vector<BodyNumber> number(count, static_body); // number of the body whose frame the node is
    auto const number_of = [&](std::size_t node) {
        if (number[node] == static_body && bodies.frames.size() <= most_bodies) {
            number[node] = static_cast<BodyNumber>(bodies.frames.size());
            bodies.frames.push_back(static_cast<Index>(node));
        }
        return number[node];
    };
    for (std::size_t i = 0; i < count; ++i) { // parents come first
        Node const& node = scene.nodes[i];
        if (node.parent != none) {
            auto const parent = static_cast<std::size_t>(node.parent);
            frame[i] = frame[parent];
            rigid_above[i] = rigid_above[parent] && motion.keeps_angles[parent];
        }
        if (motion.moves[i]) {
            frame[i] = static_cast<Index>(i);
        }
        if (node.mesh == none) {
            continue;
        }
        if (node.skin != none) { // its joints place it in the world, wherever its node is
            auto const& joints = scene.skins[static_cast<std::size_t>(node.skin)].joints;
            bodies.flows[i] = motion.morphs[i] || std::ranges::any_of(joints, [&](Index joint) {
                                  return moving[static_cast<std::size_t>(joint)];
                              });
        } else if (motion.morphs[i] || frame[i] != none) {
            std::size_t const of = frame[i] == none ? i : static_cast<std::size_t>(frame[i]);
            bodies.body_of_node[i] = number_of(of);
            bodies.flows[i] = motion.morphs[i] || !rigid_above[of] || number[of] == static_body;
        }
    }
    bodies.body_of_joint.resize(scene.skins.size());
    for (std::size_t i = 0; i < count; ++i) { // joints may come after what they move
        Node const& node = scene.nodes[i];
        if (!bodies.flows[i] || node.skin == none) {
            continue;
        }
        Skin const& skin = scene.skins[static_cast<std::size_t>(node.skin)];
        std::vector<BodyNumber>& of_joint = bodies.body_of_joint[static_cast<std::size_t>(node.skin)];
        of_joint.resize(skin.joints.size(), static_body);
        for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            for (JointInfluence const& influence : primitive.influences) {
                Index const nearest = frame[static_cast<std::size_t>(skin.joints[influence.joints[0]])];
                if (nearest != none) {
                    of_joint[influence.joints[0]] = number_of(static_cast<std::size_t>(nearest));
                }
            }
        }
    }
    return bodies;
}

BodyPose body_pose(SceneBodies const& bodies, ScenePose const& pose, BodyNumber body) {
    Index const frame = bodies.frames[body];
    if (frame == none) {
        return {};
    }
    Transform const world = transform_of(pose.world_from_node[static_cast<std::size_t>(frame)]);
    return {world.translation, world.rotation, world.scale};
}

std::vector<BodyTrack> body_tracks(PoseEvaluator& poses, SceneBodies const& bodies, std::int64_t first_key,
                                   std::size_t count) {
    std::vector<BodyTrack> tracks;
    for (std::size_t body = 1; body < bodies.frames.size(); ++body) {
        tracks.push_back({static_cast<BodyNumber>(body), first_key, {}});
        tracks.back().keys.reserve(count);
    }
    for (std::size_t key = 0; key < count && !tracks.empty(); ++key) {
        double const number = static_cast<double>(first_key) + static_cast<double>(key);
        ScenePose const& pose = poses.at(number / body_keys_per_second);
        for (BodyTrack& track : tracks) {
            track.keys.push_back(body_pose(bodies, pose, track.body));
        }
    }
    return tracks;
}

BodyTrack scene_camera_track(PoseEvaluator& poses, Index camera, std::int64_t first_key, std::size_t count) {
    BodyTrack track{camera_body(camera), first_key, {}};
    for (std::size_t key = 0; key < count; ++key) {
        double const number = static_cast<double>(first_key) + static_cast<double>(key);
        Camera const at = scene_camera(poses.scene(), poses.at(number / body_keys_per_second), camera);
        track.keys.push_back({at.position, at.orientation, Vec3(1)});
    }
    return track;
}

std::vector<bool> moving_cameras(Scene const& scene, std::span<Index const> clips) {
    std::vector<bool> const moving = moving_nodes(scene, clips);
    std::vector<bool> cameras;
    for (SceneCamera const& camera : scene.cameras) {
        cameras.push_back(moving[static_cast<std::size_t>(camera.node)]);
    }
    return cameras;
}

} // namespace framelet
