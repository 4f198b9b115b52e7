#include "tests/evaluation/live/prediction.h"

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <thread>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "tests/evaluation/comparison.h"

namespace framelet::bench {
namespace {

/// Of the pictures' references, seconds: sessions that begin at about the same time share what is kept of them.
constexpr double start_step = 0.1;

/// The machine as fast as the calibrated one: a core of it.
RunParameters on_one_core(BenchScene& scene, RunParameters run, CostTable const& costs) {
    run.frames_per_second = 1;
    run.frames_per_second = machine_factor(scene, run, costs);
    return run;
}

void serve(BenchScene& scene, std::string const& method, RunParameters const& run, CostTable const& costs) {
    auto const session = make_method(method, method_setup(run, 1, costs));
    run_method(scene, *session, run, 1, [](std::size_t, Picture const&, double) {});
}

/// What the stages take where another core is as busy: cores share caches, memory and heat.
SessionTimes clock_session(BenchScene& scene, std::string const& method, RunParameters run, CostTable const& costs) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    run = on_one_core(scene, run, costs);
    SessionTimes times;
    std::jthread const other([&file = scene.file, camera = scene.scene_camera, &method, run, &costs](
                                 std::stop_token const& stop) {
        auto const same = load_bench_scene(file, std::max(camera, 0));
        while (!stop.stop_requested()) {
            serve(*same, method, run, costs);
        }
    });
    run.times = &times;
    serve(scene, method, run, costs);
    return times;
}

} // namespace

nlohmann::json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options, SceneTime start) {
    RunParameters run;
    run.viewport = options.viewport;
    run.start = start_step * std::round(start / start_step);
    run.seconds = options.seconds;
    run.reference_rate = options.moments / (options.seconds - build_up_seconds);
    run.link = options.link;
    SessionTimes const times = clock_session(scene, method, run, options.costs);
    CostTable const costs = calibrated(options.costs, times);
    run = on_one_core(scene, run, costs);
    Reference const reference(
        scene, {run.viewport, run.seconds, run.reference_rate, options.samples_per_side, run.start},
        default_reference_cache());
    MethodRecord const record = record_method(scene, reference, method, run, 1, costs);

    double const seconds = options.seconds - build_up_seconds;
    double mse = 0, bytes = 0, count = 0;
    for (std::size_t i = 0; i < record.measures.size(); ++i) {
        if (reference_time(run, i) >= build_up_seconds) {
            mse += record.measures[i].mse;
            ++count;
        }
    }
    for (RunResult::Delivery const& delivery : record.run.deliveries) {
        bytes += delivery.sent >= build_up_seconds ? delivery.bytes : 0;
    }
    auto const pictures =
        std::ranges::count_if(record.run.displayed, [](double when) { return when >= build_up_seconds; });
    return {{"mse", mse / count},
            {"psnr", psnr_from_mse(mse / count)},
            {"kB_per_second", 1e-3 * bytes / seconds},
            {"pictures_per_second", static_cast<double>(pictures) / seconds},
            {"samples_per_second", static_cast<double>(record.run.samples) / options.seconds},
            {"server_cores", record.run.cpu.server() / options.seconds},
            {"viewer_cores", record.run.cpu.viewer() / options.seconds},
            {"factors",
             {{"plan", times.plan.factor()},
              {"render", times.render.factor()},
              {"learn", times.learn.factor()},
              {"encode", times.encode.factor()},
              {"decode", times.decode.factor()},
              {"insert", times.insert.factor()},
              {"paint", times.paint.factor()}}}};
}

} // namespace framelet::bench
