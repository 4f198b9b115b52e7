// Poses a scene at one time: finds where every node is, and the shape of what deforms.
#pragma once

#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "server/scene/scene.h"

namespace framelet {

/// World transform of every node, from the scene's origin, and the morph weights of every node that has a morphing mesh
/// (else empty).
struct ScenePose {
    SceneTime time = 0;
    std::vector<Mat4> world_from_node;
    std::vector<std::vector<float>> morph_weights;
};

/// The matrix T * R * S.
glm::dmat4 matrix_of(Transform const& transform);

/// Takes a matrix apart into translation, rotation and scale; shear is lost.
Transform transform_of(glm::dmat4 const& matrix);

/// The clips that play together: the first one, and every later one that moves nothing an earlier one moves.
std::vector<Index> default_clips(Scene const& scene);

/// The clips of these names. Throws InputError that lists the names there are.
std::vector<Index> clips_named(Scene const& scene, std::span<std::string const> names);

/// Evaluates clips at one time after another: what none of them moves is placed once. Both must outlive it.
class PoseEvaluator {
public:
    PoseEvaluator(Scene const& scene, std::span<Index const> clips);

    /// The pose at `time`, until the next call. Each clip loops with its own duration. Rotations are interpolated along
    /// the shorter arc.
    ScenePose const& at(SceneTime time);
    /// The last of these; before the first, without clips.
    ScenePose const& pose() const { return pose_; }
    Scene const& scene() const { return scene_; }

private:
    void rest(std::size_t node);
    void place(std::size_t node);

    Scene const& scene_;
    std::span<Index const> clips_;
    std::vector<Transform> locals_;
    std::vector<glm::dmat4> placed_; ///< as the files have it
    std::vector<std::size_t> animated_; ///< nodes
    std::vector<std::size_t> moving_; ///< nodes whose place in the world depends on these; parents first
    ScenePose pose_;
};

/// One pose of such.
ScenePose evaluate_pose(Scene const& scene, std::span<Index const> clips, SceneTime time);

/// True for every node whose own transform one of the clips can change.
std::vector<bool> animated_nodes(Scene const& scene, std::span<Index const> clips);

/// True for every node whose world transform one of the clips can change.
std::vector<bool> moving_nodes(Scene const& scene, std::span<Index const> clips);

/// Seconds after which all the clips together have played once (the longest); 0 where nothing is animated.
double animation_duration(Scene const& scene, std::span<Index const> clips);

/// World-space camera of the scene's camera `index` in this pose. Scale and mirroring of its node are ignored.
Camera scene_camera(Scene const& scene, ScenePose const& pose, Index index);

/// Vertices of a primitive after morphing and skinning. Space: world where `skin` is set, else the node's own.
struct DeformedVertices {
    std::vector<Vec3> positions, normals;
    std::vector<Vec4> tangents; ///< empty where the primitive has none
    std::vector<Mat4> joint_matrices; ///< scratch
};
/// Morphs and skins a primitive. Weights beyond its targets, and missing ones, count as 0. `skin` needs a primitive
/// with influences. Runs in parallel over blocks of vertices; reusing `out` for the same primitive allocates nothing.
void deform(Primitive const& primitive, std::span<float const> morph_weights, Skin const* skin, ScenePose const& pose,
            DeformedVertices& out);
/// Their positions alone, likewise, each taken on by `linear` and `translation`. `out`: as many as the primitive has.
void deform_positions(Primitive const& primitive, std::span<float const> morph_weights, Skin const* skin,
                      ScenePose const& pose, Mat3 const& linear, Vec3 const& translation, std::span<Vec3> out);

/// A primitive where a node shows it.
struct ScenePart {
    Bounds box; ///< in the world; not empty
    bool takes_light = true; ///< false: it is unlit, or black but for what it emits
};
/// The parts of everything drawn, in this pose.
std::vector<ScenePart> scene_parts(Scene const& scene, ScenePose const& pose);

/// World box of everything drawn, in this pose.
Bounds scene_bounds(Scene const& scene, ScenePose const& pose);

/// A view that frames the box: three quarters from the front and a little from above.
Camera default_camera(Bounds const& bounds);

} // namespace framelet
