#include "server/stream/posed_scene.h"

#include <utility>

#include "server/scene/motion/bodies.h"

namespace framelet {

PosedScene::PosedScene(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                       LightOptions const& light)
    : scene_(scene), clips_(std::move(clips)), render_scene_(render_scene),
      animated_(animation_duration(scene, clips_) > 0), switches_(find_switches(scene, clips_)),
      moving_cameras_(framelet::moving_cameras(scene, clips_)), pose_(evaluate_pose(scene, clips_, 0)) {
    render_scene_.set_clips(clips_);
    render_scene_.set_pose(pose_);
    if (light.method == LightMethod::reference) {
        LampSizes const sizes = lamp_sizes(light, scene_bounds(scene, pose_));
        path_light_ = std::make_unique<PathLight>(render_scene_.prepared(), sizes);
    }
}

bool PosedScene::camera_moves(int index) const {
    return index >= 0 && index < static_cast<int>(moving_cameras_.size()) &&
           moving_cameras_[static_cast<std::size_t>(index)];
}

ScenePose const& PosedScene::pose_of(SceneTime time) {
    if (pose_.time != time) {
        pose_ = evaluate_pose(scene_, clips_, time);
    }
    return pose_;
}

void PosedScene::pose(SceneTime time) {
    if (rendered_ == time) {
        return;
    }
    try {
        ScenePose const& wanted = pose_of(time);
        rendered_.reset(); // for when it fails half way
        render_scene_.set_pose(wanted);
        if (path_light_) {
            path_light_->update();
        }
    } catch (std::bad_alloc const&) {
        throw SceneUnposed();
    }
    rendered_ = time;
}

Camera PosedScene::camera(Index index, SceneTime time) {
    return scene_camera(scene_, pose_of(time), index);
}

} // namespace framelet
