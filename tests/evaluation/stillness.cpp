#include "tests/evaluation/stillness.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/picture_writer.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// The first second moves most; after two the picture should be good.
constexpr double listed_seconds[] = {0.25, 0.5, 1, 2, 4};

struct Still {
    PsnrOverTime quality;
    double last_sent = 0; ///< seconds since the stop
    double bytes = 0; ///< since the stop
    double last_second_bytes = 0;
    Picture reference;
    Picture last;
};

Still watch(BenchScene& scene, StillnessStudy const& study, StudyOptions const& options) {
    RunParameters run = options.run;
    run.seconds += study.stops;
    run.scene_stops = study.stops;
    double const machine = machine_factor(scene, options.run, options.costs);
    pose_at(scene, study.stops);
    Still still;
    still.reference = render_reference(scene, run.viewport, study.reference_side);
    auto const method = make_method("framelet", method_setup(run, machine, options.costs));
    RunResult const result =
        run_method(scene, *method, run, machine, [&](std::size_t index, Picture const& shown, double) {
            double const since = reference_time(run, index) - study.stops;
            if (since >= 0) {
                still.quality.seconds.push_back(since);
                still.quality.psnr.push_back(psnr_from_mse(mean_squared_error(shown, still.reference)));
            }
        });
    still.last = method->picture();
    for (RunResult::Delivery const& delivery : result.deliveries) {
        if (delivery.sent > study.stops) {
            still.last_sent = delivery.sent - study.stops;
            still.bytes += delivery.bytes;
        }
        still.last_second_bytes += delivery.sent > run.seconds - 1 ? delivery.bytes : 0;
    }
    return still;
}

/// What is shown in the end, beside the reference.
void write_last(std::filesystem::path const& folder, std::string const& scene, Still const& still) {
    std::filesystem::create_directories(folder);
    write_png(folder / (scene + "-still.png"), beside_reference(still.reference, std::array{still.last}));
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

json measure_stillness(StillnessStudy const& study, StudyOptions const& options) {
    FRAMELET_CHECK(options.run.seconds >= 1);
    Viewport const viewport = options.run.viewport;
    std::printf("%dx%d, %g samples a pixel and second; PSNR [dB] after everything has come to rest\n", viewport.width,
                viewport.height, options.run.frames_per_second);
    std::printf("%-18s", "after [s]");
    for (double const after : listed_seconds) {
        std::printf("  %6.2f", after);
    }
    std::printf("     end  falls [dB]  last sent [s]       kB  bytes in the last second\n");
    json rows = json::array();
    Curves curves{.title = "PSNR after everything has come to rest",
                  .x_title = "time since [s]",
                  .y_title = "PSNR [dB]",
                  .points = false,
                  .curves = {}};
    for (std::filesystem::path const& file : options.scenes) {
        auto const scene = load_bench_scene(file, options.camera);
        Still const still = watch(*scene, study, options);
        std::printf("%-18s", scene->name.c_str());
        json psnr = json::array();
        for (double const after : listed_seconds) {
            if (after <= options.run.seconds) {
                std::printf("  %6.2f", still.quality.at(after));
                psnr.push_back({{"after_seconds", after}, {"psnr", still.quality.at(after)}});
            }
        }
        std::printf("  %6.2f  %10.3f  %13.2f  %7.0f  %24.0f\n", still.quality.psnr.back(), still.quality.most_fall(),
                    still.last_sent, 1e-3 * still.bytes, still.last_second_bytes);
        std::fflush(stdout);
        rows.push_back({{"scene", scene->name},
                        {"psnr", psnr},
                        {"final_psnr", still.quality.psnr.back()},
                        {"most_fall_db", still.quality.most_fall()},
                        {"last_sent_seconds", still.last_sent},
                        {"bytes", still.bytes},
                        {"last_second_bytes", still.last_second_bytes}});
        if (!options.charts.empty()) {
            write_last(options.charts, scene->name, still);
        }
        curves.curves.push_back({scene->name, still.quality.seconds, still.quality.psnr});
    }
    if (!options.charts.empty()) {
        draw(curves, options.charts / "stillness");
    }
    return rows;
}

} // namespace framelet::bench
