// A scene loaded and ready to be rendered at any of its times, as every verb of framelet-bench needs it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/render/framelet_renderer.h"
#include "server/scene/motion/animation.h"
#include "server/stream/posed_scene.h"
#include "tests/evaluation/camera_turn.h"

namespace framelet::bench {

struct BenchScene {
    std::filesystem::path file;
    std::string name; ///< stem of the file
    Scene scene;
    std::vector<Index> clips;
    std::unique_ptr<RenderScene> render_scene; ///< reads `scene`
    std::unique_ptr<PosedScene> posed; ///< poses `render_scene`: nobody else does
    Index scene_camera = none; ///< looked through; none: `default_camera`
    Camera default_camera;
    CameraTurn turn; ///< of whichever camera
    std::function<Camera(SceneTime)> flown; ///< where there is one: the viewer's own camera, that goes by itself
    Camera camera; ///< at the time that the scene was posed for last
    float exposure = 1;
    double duration = 0; ///< seconds of animation; 0: nothing moves
    ScenePose pose; ///< that the scene was posed for last

    /// The camera of the scene that is looked through as it goes; -1: the camera is the viewer's own.
    int followed_camera() const { return turn.turns() || flown ? -1 : static_cast<int>(scene_camera); }
};

/// Which animations play: `none`, and it stands still.
enum class Clips { usual, none };

/// Loads the scene and poses it at time 0. It is seen by its first camera, or by the default one where it has none.
/// Throws InputError.
std::unique_ptr<BenchScene> load_bench_scene(std::filesystem::path const& file, Clips clips = Clips::usual);

/// Moves everything, the camera included, to where it is at `time`.
void pose_at(BenchScene& scene, SceneTime time);

/// Everything stands where it did, whatever the time.
bool same_pose(ScenePose const& a, ScenePose const& b);

/// Where the camera is at `time`; the scene stays as it is.
Camera camera_at(BenchScene const& scene, SceneTime time);
/// Where the scene itself has it, whatever its viewer does with it.
Camera own_camera_at(BenchScene const& scene, SceneTime time);

} // namespace framelet::bench
