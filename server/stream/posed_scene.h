// The scene that all streams look at, at one moment at a time. In: scene times. Out: where its cameras are, what is
// rendered. A resource: posing moves the renderer's scene.
#pragma once

#include <memory>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "server/render/gathering/light_gathering.h"
#include "server/render/gathering/light_walk.h"
#include "server/render/path/path_light.h"
#include "server/render/prepared/render_scene.h"
#include "server/scene/motion/animation.h"
#include "server/scene/motion/switches.h"
#include "server/workers/path_round.h"

namespace framelet {

/// Memory was missing for what all viewers look at, whoever's turn it was. Another time there may be enough.
struct SceneUnposed : std::bad_alloc {
    char const* what() const noexcept override { return "there is not enough memory left to move the scene"; }
};

class PosedScene {
public:
    /// Poses the scene for time 0. Scene and renderer must outlive it.
    PosedScene(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene, LightOptions const& light = {});
    ~PosedScene() { render_scene_.set_light(nullptr, {}); }
    PosedScene(PosedScene const&) = delete;
    PosedScene& operator=(PosedScene const&) = delete;

    Scene const& scene() const { return scene_; }
    std::span<Index const> clips() const { return clips_; }
    RenderScene const& render_scene() const { return render_scene_; }
    /// What finds the light of its pose by paths; null where light is direct.
    PathLight const* path_light() const { return path_light_.get(); }
    /// What gathers light for the cache by which it is rendered; null where it is rendered without one.
    LightGathering* light_gathering() const { return gathering_.get(); }
    bool is_animated() const { return animated_; }
    /// Times at which its clips jump.
    std::span<ClipSwitches const> switches() const { return switches_; }

    /// Finds light by `light` from now on. To be called before anybody looks.
    void light_with(LightOptions const& light);
    /// Learns light that nobody waits for, for some milliseconds on the calling TBB arena: what was looked at lately,
    /// then what viewers may come to see. False once all of it is good enough.
    /// `workers`, where there are some, help with it.
    bool learn_light(WorkerPool* workers = nullptr);
    /// What paths bring in its first pose: the same number for every process that finds the same light of the same
    /// scene, to the last bit, and hardly ever for another. 0 where light is direct.
    std::uint64_t light_identity() const { return light_identity_; }

    /// Moves everything that is rendered to where it is at `time`; false where it is there already. Throws SceneUnposed
    /// where it cannot; until it can, nothing is to be rendered.
    bool pose(SceneTime time);
    /// The pose of everything at `time`; valid until the next call. The renderer's scene stays as it is.
    ScenePose const& pose_of(SceneTime time);
    /// Evaluates its poses: what `pose_of` gave is gone with the next one.
    PoseEvaluator& poses() { return poses_; }
    /// The scene's camera `index` at `time`. The renderer's scene stays as it is.
    Camera camera(Index index, SceneTime time);
    /// True for a camera of the scene that goes with something that moves.
    bool camera_moves(int index) const;

private:
    std::vector<Camera> first_cameras(Bounds const& bounds);
    void learn_first_light();
    std::uint64_t probe_light(Camera const& camera) const;

    Scene const& scene_;
    std::vector<Index> const clips_;
    RenderScene& render_scene_;
    bool const animated_;
    std::vector<ClipSwitches> const switches_;
    std::vector<bool> const moving_cameras_;
    PoseEvaluator poses_;
    std::unique_ptr<PathLight> path_light_;
    std::unique_ptr<LightCache> light_cache_;
    std::unique_ptr<LightGathering> gathering_;
    std::optional<LightWalk> walk_; ///< where light is gathered
    std::size_t paths_since_look_ = 0; ///< of the walk
    std::uint64_t light_identity_ = 0;
    /// The time that the renderer's scene is posed for; nothing: posing it failed half way.
    std::optional<SceneTime> rendered_ = 0;
};

} // namespace framelet
