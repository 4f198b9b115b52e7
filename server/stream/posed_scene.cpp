#include "server/stream/posed_scene.h"

#include <utility>

#include <glm/geometric.hpp>

#include "server/render/picture_renderer.h"
#include "server/scene/motion/bodies.h"

namespace framelet {

PosedScene::PosedScene(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                       LightOptions const& light)
    : scene_(scene), clips_(std::move(clips)), render_scene_(render_scene),
      animated_(animation_duration(scene, clips_) > 0), switches_(find_switches(scene, clips_)),
      moving_cameras_(framelet::moving_cameras(scene, clips_)), poses_(scene, clips_) {
    render_scene_.set_clips(clips_);
    ScenePose const& pose = poses_.at(0);
    render_scene_.set_pose(pose);
    if (light.method != LightMethod::direct) {
        Bounds const bounds = scene_bounds(scene, pose);
        PathOptions options;
        options.sizes = lamp_sizes(light, bounds);
        path_light_ = std::make_unique<PathLight>(render_scene_.prepared(), options);
        if (light.method == LightMethod::full) {
            light_cache_ = std::make_unique<LightCache>(bounds.empty() ? 1.0f : glm::length(bounds.size()));
            gathering_ = std::make_unique<LightGathering>(*path_light_, *light_cache_);
            render_scene_.set_light(light_cache_.get(), options.sizes);
            learn_first_light(scene.cameras.empty() ? default_camera(bounds) : camera(0, 0));
        }
    }
}

/// Learns how bright the scene is, and coarsely where, before anybody sees it.
void PosedScene::learn_first_light(Camera const& camera) {
    constexpr Viewport few_pixels{160, 120};
    constexpr std::size_t slice = 4096, slices = 4;
    render_radiance(render_scene_, camera, few_pixels, 1);
    for (std::size_t i = 0; i < slices; ++i) {
        gathering_->work(slice);
    }
}

bool PosedScene::camera_moves(int index) const {
    return index >= 0 && index < static_cast<int>(moving_cameras_.size()) &&
           moving_cameras_[static_cast<std::size_t>(index)];
}

ScenePose const& PosedScene::pose_of(SceneTime time) {
    return poses_.pose().time == time ? poses_.pose() : poses_.at(time);
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
        if (gathering_) {
            gathering_->note_pose();
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
