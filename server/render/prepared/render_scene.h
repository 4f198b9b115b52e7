// A scene made ready to be rendered: BVHs, mip chains, materials, lights, environment. A resource; its pose changes
// between cycles, and everything reads it during one.
#pragma once

#include <memory>
#include <optional>

#include "common/color.h"
#include "server/render/light/environment.h"
#include "server/render/light/lamp_sizes.h"
#include "server/render/surface/geometry.h"
#include "server/scene/motion/animation.h"
#include "server/scene/motion/bodies.h"
#include "server/scene/motion/switches.h"
#include "server/scene/reading/progress.h"
#include "server/scene/scene.h"

namespace framelet {

class LightCache;
struct PreparedScene;

class RenderScene {
public:
    /// Builds every BVH and mip chain, in the pose that the scene has without its clips. `scene` must outlive this.
    /// What `progress` throws is thrown.
    /// Light: an `environment` adds to the scene's lights. Without one, a scene without lights gets the default sky and
    /// a sun; one with a sun of its own the sky of that brightness; one with other lights only, dim uniform light.
    RenderScene(Scene const& scene, std::optional<Environment> environment, Progress const& progress = {});
    ~RenderScene();
    RenderScene(RenderScene const&) = delete;
    RenderScene& operator=(RenderScene const&) = delete;

    /// Moves instances, refits what deforms. Costs nothing but a comparison for what does not move. Not to be called
    /// while anything renders. `pose` must be of this scene. Where it throws, because memory has run out, the scene is
    /// not to be rendered before a pose has been set, which then moves everything, and where Embree was without memory
    /// builds every BVH anew.
    void set_pose(ScenePose const& pose);

    /// From now on framelets say which bodies carry their samples and how these drift besides, while these clips play.
    /// Not to be called while anything renders. At first nothing plays: everything is static.
    void set_clips(std::span<Index const> clips);
    SceneBodies const& bodies() const { return bodies_; }

    /// From now on light from all around is of this cache, which must outlive all rendering; null: of the environment.
    /// Punctual lights have these sizes.
    void set_light(LightCache* cache, LampSizes sizes);

    /// From now on unlit surfaces have the radiance that is shown as their colour by this. At first it is their colour.
    void set_display(DisplayTransform const& display);

    PreparedScene const& prepared() const { return *prepared_; }

private:
    /// A node that draws a mesh.
    struct Placement {
        std::size_t node; ///< index in the scene
        std::uint32_t mesh, instance; ///< numbers in the BVH
        Skin const* skin; ///< null: none
        bool morphs;
        std::size_t deformed; ///< index into `deformed_`, where it deforms

        bool deforms() const { return skin != nullptr || morphs; }
    };
    using MeshVertices = std::vector<DeformedVertices>; ///< one for each primitive

    void add_meshes(Progress const& progress);
    void set_transform(Placement const& placement);
    void build_anew();
    void deform_mesh(Placement const& placement);
    bool moved(Placement const& placement, ScenePose const& pose) const;
    bool reshaped(Placement const& placement, ScenePose const& pose) const;
    void update_lights();
    void update_motion();
    void place_elsewhen(Placement const& placement, std::size_t time, ScenePose const& other);
    void deform_elsewhen(Placement const& placement, std::size_t time, ScenePose const& other);
    void move_bodies(std::size_t time, ScenePose const& other);
    bool throws_moving_shadow(Placement const& placement) const;

    Scene const& scene_;
    std::unique_ptr<PreparedScene> prepared_;
    std::vector<Placement> placements_;
    std::vector<MeshVertices> deformed_; ///< normals and tangents of deforming meshes live here
    ScenePose pose_;
    bool is_built_ = true; ///< every BVH is there
    bool is_placed_ = false; ///< everything stands as `pose_` says
    std::vector<Index> clips_;
    std::optional<PoseEvaluator> other_poses_; ///< of `clips_`
    SceneBodies bodies_;
    std::vector<ClipSwitches> switches_; ///< of `clips_`
    /// By deforming mesh and primitive: where its vertices are in the world at other times, and the bodies of its
    /// triangles.
    struct DeformedMotion {
        std::array<std::vector<Vec3>, motion_times> elsewhen;
        std::vector<BodyNumber> bodies;
    };
    std::vector<std::vector<DeformedMotion>> deformed_motion_;
};

} // namespace framelet
