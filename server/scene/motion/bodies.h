// Finds which rigid body carries every node, and where the bodies are. In: scene, playing clips, times. Out: numbers,
// poses.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/framelet/body_track.h"
#include "server/scene/motion/animation.h"

namespace framelet {

/// Nodes that keep their places relative to each other, whatever the time, are of one body. That is decided by
/// structure: a node is of the body of the nearest node among itself and its ancestors that the clips move. What is
/// skinned is carried by its joints, each triangle by the one that moves it most; what morphs by a body of its own
/// where none carries it.
struct SceneBodies {
    /// Number of the body that carries each node: the static body for skinned nodes and those that draw nothing.
    std::vector<BodyNumber> body_of_node;
    /// Numbers of the bodies of joints, by skin and joint; those of joints that move no vertex most say nothing.
    std::vector<std::vector<BodyNumber>> body_of_joint;
    /// Nodes whose meshes do not just go with a body: skinned, morphing, carried by a transform that shears in the
    /// course of time, or too many. Their samples drift. Only nodes that draw something.
    std::vector<bool> flows;
    /// Frames of the bodies by body number: the node whose world transform is the body's pose. `none` for the static
    /// body.
    std::vector<Index> frames{none};

    bool any_moves() const { return frames.size() > 1; }
    bool any_flows() const;
};

/// The largest body number: a batch has room for the tracks of so many.
inline constexpr std::size_t most_bodies = max_batch_tracks;

/// Numbers the bodies in the order of their nodes; only those that draw something get a number, and no more than
/// `most_bodies` of them.
SceneBodies find_bodies(Scene const& scene, std::span<Index const> clips);

/// The joint, as a position in its skin, that moves a triangle of a skinned primitive most.
std::size_t joint_of(Primitive const& primitive, std::array<std::uint32_t, 3> const& triangle);

/// Pose of the body in this pose of its scene. It is finite; its rotation has unit length.
BodyPose body_pose(SceneBodies const& bodies, ScenePose const& pose, BodyNumber body);

/// Tracks of all bodies but the static one, by body number: `count` keys from `first_key` on.
std::vector<BodyTrack> body_tracks(PoseEvaluator& poses, SceneBodies const& bodies, std::int64_t first_key,
                                   std::size_t count);

/// Track of a camera of the scene under the number `camera_body`: from where it looks at the world.
BodyTrack scene_camera_track(PoseEvaluator& poses, Index camera, std::int64_t first_key, std::size_t count);

/// True for each camera of the scene that goes with something that moves.
std::vector<bool> moving_cameras(Scene const& scene, std::span<Index const> clips);

} // namespace framelet
