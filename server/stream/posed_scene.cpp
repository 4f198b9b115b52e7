#include "server/stream/posed_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <glm/geometric.hpp>
#include <tbb/global_control.h>

#include "common/mix_bits.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/visible_tiles.h"
#include "server/scene/motion/bodies.h"

namespace framelet {

PosedScene::PosedScene(Scene const& scene, std::vector<Index> clips, RenderScene& render_scene,
                       LightOptions const& light)
    : scene_(scene), clips_(std::move(clips)), render_scene_(render_scene),
      animated_(animation_duration(scene, clips_) > 0), switches_(find_switches(scene, clips_)),
      moving_cameras_(framelet::moving_cameras(scene, clips_)), poses_(scene, clips_) {
    render_scene_.set_clips(clips_);
    render_scene_.set_pose(poses_.at(0));
    light_with(light);
}

void PosedScene::light_with(LightOptions const& light) {
    walk_.reset();
    gathering_.reset();
    render_scene_.set_light(nullptr, {});
    light_cache_.reset();
    path_light_.reset();
    light_identity_ = 0;
    if (light.method == LightMethod::direct) {
        return;
    }
    Bounds const bounds = scene_bounds(scene_, poses_.pose());
    PathOptions options;
    options.sizes = lamp_sizes(light, bounds);
    path_light_ = std::make_unique<PathLight>(render_scene_.prepared(), options);
    std::vector<Camera> cameras = first_cameras(bounds);
    light_identity_ = probe_light(cameras.front());
    if (light.method == LightMethod::full) {
        light_cache_ = std::make_unique<LightCache>(bounds.empty() ? 1.0f : glm::length(bounds.size()));
        gathering_ = std::make_unique<LightGathering>(*path_light_, *light_cache_);
        render_scene_.set_light(light_cache_.get(), options.sizes);
        walk_.emplace(std::move(cameras));
        learn_first_light();
    }
}

/// What viewers look through at first.
std::vector<Camera> PosedScene::first_cameras(Bounds const& bounds) {
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
        cameras.push_back(camera(static_cast<Index>(i), 0));
    }
    return cameras.empty() ? std::vector{default_camera(bounds)} : cameras;
}

/// Learns how bright the scene is, and coarsely where, before anybody sees it.
void PosedScene::learn_first_light() {
    constexpr std::size_t slice = 4096, slices = 4;
    walk_->look(render_scene_);
    for (std::size_t i = 0; i < slices; ++i) {
        gathering_->work(slice);
    }
}

/// A digest of what a path through each sample of a small picture brings, of which program and processor have a part;
/// and of what may be nowhere in that: clips, lamps, the environment.
std::uint64_t PosedScene::probe_light(Camera const& camera) const {
    constexpr Viewport probe{32, 32};
    ImagePlane const plane(probe);
    ViewRays const rays = make_view_rays(camera, probe);
    std::uint64_t digest = 1;
    auto const add = [&digest](auto const& floats) {
        for (float const value : floats) {
            digest = mix_in(digest, std::bit_cast<std::uint32_t>(value));
        }
    };
    TileLight light;
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth())) {
        trace_tile(*path_light_, rays, plane, tile, 0, light);
        add(light.red);
        add(light.green);
        add(light.blue);
    }
    for (Index const clip : clips_) {
        digest = mix_in(digest, static_cast<std::uint64_t>(clip));
    }
    LampSizes const& sizes = path_light_->options().sizes;
    add(std::array{sizes.sun, sizes.lamp});
    for (Light const& lamp : scene_.lights) {
        digest = mix_in(digest, static_cast<std::uint64_t>(lamp.type) << 32 ^ static_cast<std::uint64_t>(lamp.node));
        add(std::array{lamp.color.r, lamp.color.g, lamp.color.b, lamp.intensity, lamp.range, lamp.inner_cone,
                       lamp.outer_cone});
    }
    for (int axis = 0; axis < 6; ++axis) {
        Vec3 direction(0);
        direction[axis % 3] = axis < 3 ? 1.0f : -1.0f;
        Vec3 const color = render_scene_.prepared().environment.diffuse(direction);
        add(std::array{color.r, color.g, color.b});
    }
    return std::max(digest, std::uint64_t{1});
}

bool PosedScene::learn_light(WorkerPool* workers) {
    constexpr double slice = 0.008; // seconds: whoever comes meanwhile waits so long
    constexpr std::size_t paths_a_look = 1 << 16;
    if (!gathering_) {
        return false;
    }
    if (!walk_->is_over() && (paths_since_look_ >= paths_a_look || !gathering_->is_learning())) {
        walk_->look(render_scene_);
        light_cache_->note_unwatched();
        paths_since_look_ = 0;
    }
    auto const threads =
        static_cast<double>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    std::size_t const packets = gathering_->plan(gathering_->paths_in(slice * threads), LightCache::Use::any);
    PathRound round;
    round.begin(workers, *path_light_, {rendered_.value_or(0), {}}, {}, gathering_.get(), packets);
    round.finish();
    paths_since_look_ += gathering_->finish();
    return gathering_->is_learning() || !walk_->is_over();
}

bool PosedScene::camera_moves(int index) const {
    return index >= 0 && index < static_cast<int>(moving_cameras_.size()) &&
           moving_cameras_[static_cast<std::size_t>(index)];
}

ScenePose const& PosedScene::pose_of(SceneTime time) {
    return poses_.pose().time == time ? poses_.pose() : poses_.at(time);
}

bool PosedScene::pose(SceneTime time) {
    if (rendered_ == time) {
        return false;
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
    return true;
}

Camera PosedScene::camera(Index index, SceneTime time) {
    return scene_camera(scene_, pose_of(time), index);
}

} // namespace framelet
