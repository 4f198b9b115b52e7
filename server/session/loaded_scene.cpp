#include "server/session/loaded_scene.h"

#include <cmath>
#include <utility>

#include "server/render/framelet_renderer.h"
#include "server/scene/motion/animation.h"

namespace framelet {

LoadedScene::LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                         std::optional<float> exposure_ev, Progress const& progress)
    : scene(std::move(imported)), clips(std::move(playing)), render_scene(scene, std::move(environment), progress) {
    ScenePose const pose = evaluate_pose(scene, clips, 0);
    render_scene.set_pose(pose);
    Camera const start =
        scene.cameras.empty() ? default_camera(scene_bounds(scene, pose)) : scene_camera(scene, pose, 0);
    exposure = exposure_ev ? std::exp2(*exposure_ev) : auto_exposure(render_scene, start);
}

} // namespace framelet
