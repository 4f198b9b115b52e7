#include "tests/evaluation/bench_scene.h"

#include "server/scene/scene_import.h"

namespace framelet::bench {

std::unique_ptr<BenchScene> load_bench_scene(std::filesystem::path const& file) {
    auto loaded = std::make_unique<BenchScene>();
    loaded->scene = import_scene(file);
    loaded->clips = default_clips(loaded->scene);
    loaded->render_scene = std::make_unique<RenderScene>(loaded->scene, std::nullopt);
    ScenePose const pose = evaluate_pose(loaded->scene, loaded->clips, 0);
    loaded->render_scene->set_pose(pose);
    loaded->camera = loaded->scene.cameras.empty() ? default_camera(scene_bounds(loaded->scene, pose))
                                                   : scene_camera(loaded->scene, pose, 0);
    loaded->exposure = auto_exposure(*loaded->render_scene, loaded->camera);
    return loaded;
}

} // namespace framelet::bench
