#include "tests/evaluation/stillness.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double stops = 0.5; ///< seconds of the run at which everything stops
constexpr int reference_side = 16; ///< samples along a side of the reference's pixel
/// Times after the stop that are listed, seconds: the first second changes most; after two the picture should be good.
constexpr double listed_seconds[] = {0.25, 0.5, 1, 2, 4};

struct Still {
    PsnrOverTime quality;
    double last_sent = 0; ///< last time at which something was sent, seconds since the stop
    double bytes = 0; ///< bytes sent since the stop
    double last_second_bytes = 0;
};

Still watch(BenchScene& scene, StudyOptions const& options) {
    RunParameters run = options.run;
    run.seconds += stops;
    run.scene_stops = stops;
    double const machine = machine_factor(scene, options.run, options.costs);
    pose_at(scene, run.start + stops);
    Still still;
    Picture const reference = render_reference(scene, run.viewport, reference_side);
    auto const method = make_method("framelet", method_setup(run, machine, options.costs));
    RunResult const result =
        run_method(scene, *method, run, machine, [&](std::size_t index, Picture const& shown, double) {
            double const since = reference_time(run, index) - stops;
            if (since >= 0) {
                still.quality.seconds.push_back(since);
                still.quality.psnr.push_back(psnr_from_mse(mean_squared_error(shown, reference)));
            }
        });
    for (RunResult::Delivery const& delivery : result.deliveries) {
        if (delivery.sent > stops) {
            still.last_sent = delivery.sent - stops;
            still.bytes += delivery.bytes;
        }
        still.last_second_bytes += delivery.sent > run.seconds - 1 ? delivery.bytes : 0;
    }
    return still;
}

} // namespace

double PsnrOverTime::at(double after) const {
    auto const next = std::ranges::upper_bound(seconds, after + 1e-6);
    return psnr[static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - seconds.begin(), 1) - 1)];
}

double PsnrOverTime::most_fall() const {
    double best = psnr.front(), fall = 0;
    for (double const value : psnr) {
        best = std::max(best, value);
        fall = std::max(fall, best - value);
    }
    return fall;
}

json measure_stillness(StudyOptions const& options) {
    FRAMELET_CHECK(options.run.seconds >= 1);
    std::printf("%dx%d, %g samples a pixel and second; PSNR [dB] after everything has come to rest\n",
                options.run.viewport.width, options.run.viewport.height, options.run.frames_per_second);
    FigureTable const table({{"after [s]", "/scene", -17},
                             {"0.25", "/psnr/0/psnr", 6},
                             {"0.5", "/psnr/1/psnr", 6},
                             {"1", "/psnr/2/psnr", 6},
                             {"2", "/psnr/3/psnr", 6},
                             {"4", "/psnr/4/psnr", 6},
                             {"end", "/final_psnr", 6},
                             {"falls [dB]", "/most_fall_db", 10, 3},
                             {"last sent [s]", "/last_sent_seconds", 13},
                             {"kB", "/bytes", 7, 0, 1e-3},
                             {"bytes in the last second", "/last_second_bytes", 24, 0}});
    json rows = json::array();
    for (std::filesystem::path const& file : options.scenes) {
        auto const scene = load_bench_scene(file);
        Still const still = watch(*scene, options);
        json psnr = json::array();
        for (double const after : listed_seconds) {
            if (after <= options.run.seconds) {
                psnr.push_back({{"after_seconds", after}, {"psnr", still.quality.at(after)}});
            }
        }
        rows.push_back({{"scene", scene->name},
                        {"psnr", psnr},
                        {"final_psnr", still.quality.psnr.back()},
                        {"most_fall_db", still.quality.most_fall()},
                        {"last_sent_seconds", still.last_sent},
                        {"bytes", still.bytes},
                        {"last_second_bytes", still.last_second_bytes}});
        table.print(rows.back());
    }
    return rows;
}

} // namespace framelet::bench
