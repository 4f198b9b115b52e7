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
    Index scene_camera = none; ///< number of the scene's camera that is looked through; none: `default_camera`
    Camera default_camera;
    CameraTurn turn; ///< turning added to whichever camera is used
    /// The viewer's own camera, which flies by itself; empty: there is none.
    std::function<Camera(SceneTime)> flown;
    double orthographic_height = 0; ///< metres; > 0: whichever camera is used is orthographic
    Camera camera; ///< the camera at the time for which the scene was posed last
    float exposure = 1;
    double duration = 0; ///< seconds of animation; 0: nothing moves
    ScenePose pose; ///< the pose for which the scene was posed last

    /// Number of the scene's camera that the viewer follows along its track; -1: the camera is the viewer's own.
    int followed_camera() const {
        return turn.turns() || flown || orthographic_height > 0 ? -1 : static_cast<int>(scene_camera);
    }
};

/// The animations that play: the usual ones; none, so that the scene stands still; or the usual ones as exporters bake
/// them that write a key for each frame: every jump is a straight way that takes a 30th of a second.
enum class Clips { usual, none, baked };

/// Loads the scene and poses it at time 0. The viewer looks through its first camera, or through the default one where
/// it has none. `environment`: a map that lights it; empty: none. Throws InputError.
std::unique_ptr<BenchScene> load_bench_scene(std::filesystem::path const& file, Clips clips = Clips::usual,
                                             std::filesystem::path const& environment = {},
                                             LightMethod light = LightMethod::direct);

/// Moves everything, the camera included, to where it is at scene time `time`.
void pose_at(BenchScene& scene, SceneTime time);

/// True where everything stands at the same place in both poses, whatever their times.
bool same_pose(ScenePose const& a, ScenePose const& b);

/// The camera (with its turning or flight) at scene time `time`; the scene stays as it is.
Camera camera_at(BenchScene const& scene, SceneTime time);
/// The scene's own camera at `time`, without what its viewer does with it.
Camera own_camera_at(BenchScene const& scene, SceneTime time);

} // namespace framelet::bench
