#include "tests/evaluation/bench_scene.h"

#include <algorithm>
#include <utility>

#include "server/render/first_look.h"
#include "server/scene/backdrop.h"
#include "server/scene/scene_import.h"

namespace framelet::bench {
namespace {

/// Makes every jump of the clip a straight way that takes a 30th of a second, as far as there is so much time before
/// it.
void bake(AnimationClip& clip) {
    constexpr float frame = 1 / 30.0f; // seconds
    for (AnimationChannel& channel : clip.channels) {
        if (channel.interpolation != Interpolation::step) {
            continue;
        }
        AnimationChannel baked = channel;
        baked.interpolation = Interpolation::linear;
        baked.times.clear();
        baked.values.clear();
        auto const add = [&](float time, std::size_t key) {
            auto const value = channel.values.begin() + static_cast<std::ptrdiff_t>(key) * channel.components;
            baked.times.push_back(time);
            baked.values.insert(baked.values.end(), value, value + channel.components);
        };
        for (std::size_t key = 0; key < channel.times.size(); ++key) {
            if (key > 0 && channel.times[key] - frame > channel.times[key - 1]) {
                add(channel.times[key] - frame, key - 1);
            }
            add(channel.times[key], key);
        }
        channel = std::move(baked);
    }
}

Camera with_lens(Camera camera, BenchScene const& scene) {
    if (scene.orthographic_height > 0) {
        camera.projection = Projection::orthographic;
        camera.vertical_extent = static_cast<float>(scene.orthographic_height);
    }
    return camera;
}

} // namespace

std::unique_ptr<BenchScene> load_bench_scene(std::filesystem::path const& file, Clips clips,
                                             std::filesystem::path const& environment, LightMethod light) {
    auto loaded = std::make_unique<BenchScene>();
    loaded->file = file;
    loaded->name = file.stem().string();
    loaded->scene = import_scene(file);
    if (clips == Clips::none) {
        loaded->scene.clips.clear();
    } else if (clips == Clips::baked) {
        std::ranges::for_each(loaded->scene.clips, bake);
    }
    loaded->clips = default_clips(loaded->scene);
    loaded->duration = animation_duration(loaded->scene, loaded->clips);
    loaded->render_scene = std::make_unique<RenderScene>(
        loaded->scene, environment.empty() ? std::nullopt : std::optional(Environment::load(environment)));
    loaded->posed =
        std::make_unique<PosedScene>(loaded->scene, loaded->clips, *loaded->render_scene, LightOptions{light});
    loaded->pose = loaded->posed->pose_of(0);
    loaded->scene_camera = loaded->scene.cameras.empty() ? none : 0;
    loaded->default_camera = default_camera(without_backdrop(scene_parts(loaded->scene, loaded->pose)));
    loaded->camera = camera_at(*loaded, 0);
    loaded->exposure = auto_exposure(*loaded->render_scene, loaded->camera, loaded->posed->path_light());
    loaded->render_scene->set_display(loaded->exposure);
    return loaded;
}

void pose_at(BenchScene& scene, SceneTime time) {
    if (time != scene.pose.time) {
        scene.pose = scene.posed->pose_of(time);
    }
    scene.posed->pose(time);
    scene.camera = camera_at(scene, time);
}

bool same_pose(ScenePose const& a, ScenePose const& b) {
    return a.world_from_node == b.world_from_node && a.morph_weights == b.morph_weights;
}

Camera camera_at(BenchScene const& scene, SceneTime time) {
    return scene.flown ? with_lens(scene.flown(time), scene) : turned(own_camera_at(scene, time), scene.turn, time);
}

Camera own_camera_at(BenchScene const& scene, SceneTime time) {
    return with_lens(scene.scene_camera == none ? scene.default_camera : scene.posed->camera(scene.scene_camera, time),
                     scene);
}

} // namespace framelet::bench
