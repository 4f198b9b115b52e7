#include "tests/evaluation/study.h"

#include "tests/evaluation/scene_events.h"

namespace framelet::bench {

Reference reference_of(BenchScene& scene, StudyOptions const& options) {
    RunParameters const& run = options.run;
    return {scene,
            {run.viewport, run.seconds, run.reference_rate, options.samples_per_side, run.start},
            options.reference_cache};
}

Subject prepare(std::filesystem::path const& file, StudyOptions const& options) {
    auto scene = load_bench_scene(file);
    scene->turn.degrees_per_second = options.turn;
    StudyOptions of_scene = options;
    if (options.sees_events) {
        of_scene.run.start = window_start(scene->name, options.run.seconds);
    }
    Reference reference = reference_of(*scene, of_scene);
    double const machine = machine_factor(*scene, of_scene.run, options.costs);
    return {std::move(scene), of_scene.run, std::move(reference), machine};
}

} // namespace framelet::bench
