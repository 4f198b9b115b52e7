#include "tests/evaluation/smoothness.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/picture_writer.h"
#include "tests/evaluation/charts/side_by_side.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/shown_pictures.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// `value(i, byte)`: byte of picture i.
template <class Value>
double second_differences(std::span<Picture const> pictures, Value&& value) {
    FRAMELET_CHECK(pictures.size() >= 3 && !pictures.front().rgba.empty());
    std::size_t const bytes = pictures.front().rgba.size();
    double sum = 0;
    for (std::size_t i = 1; i + 1 < pictures.size(); ++i) {
        FRAMELET_CHECK(pictures[i - 1].rgba.size() == bytes && pictures[i + 1].rgba.size() == bytes);
        std::int64_t squares = 0;
        for (std::size_t byte = 0; byte < bytes; ++byte) { // alpha is always the same
            int const difference = value(i + 1, byte) - 2 * value(i, byte) + value(i - 1, byte);
            squares += difference * difference;
        }
        sum += static_cast<double>(squares);
    }
    return sum / (255.0 * 255.0 * 3 * static_cast<double>(bytes / 4) * static_cast<double>(pictures.size() - 2));
}

/// The scene as it was `lag` seconds before each reference time, seen by the camera of that time.
std::vector<Picture> late_reference(BenchScene& scene, StudyOptions const& options, double lag) {
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < reference_count(options.run); ++i) {
        double const now = reference_time(options.run, i);
        pose_at(scene, std::max(0.0, now - lag));
        scene.camera = camera_at(scene, now);
        pictures.push_back(render_reference(scene, options.run.viewport, options.samples_per_side));
    }
    return pictures;
}

double mean_error(std::vector<Picture> const& shown, std::vector<Picture> const& reference) {
    double sum = 0;
    for (double const error : errors_of(shown, reference)) {
        sum += error;
    }
    return sum / static_cast<double>(shown.size());
}

struct Lagging {
    double lag_ms = 0;
    std::vector<Picture> reference, shown;
};

/// What was shown in the middle and shortly after that, each beside what was to be shown.
void write_pictures(std::string const& scene, Lagging const& run, std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    for (std::size_t later = 0; later < 3; ++later) {
        std::size_t const i = std::min(run.shown.size() / 2 + 2 * later, run.shown.size() - 1);
        std::array<char, 64> name{};
        std::snprintf(name.data(), name.size(), "-lag%.0f-%zu.png", run.lag_ms, later);
        write_png(folder / (scene + name.data()),
                  side_by_side(run.reference[i], std::array{Labelled{"shown", run.shown[i]}}));
    }
}

} // namespace

double mean_squared_second_difference(std::span<Picture const> pictures) {
    return second_differences(pictures, [&](std::size_t i, std::size_t byte) { return int{pictures[i].rgba[byte]}; });
}

double mean_squared_second_difference(std::span<Picture const> pictures, std::span<Picture const> reference) {
    FRAMELET_CHECK(reference.size() == pictures.size());
    return second_differences(pictures, [&](std::size_t i, std::size_t byte) {
        return int{pictures[i].rgba[byte]} - int{reference[i].rgba[byte]};
    });
}

json measure_smoothness(SmoothnessStudy const& study, StudyOptions const& options) {
    Viewport const viewport = options.run.viewport;
    std::printf("%dx%d, %.3g s, %.0f pictures a second, %.0f whole frames a second\n", viewport.width, viewport.height,
                options.run.seconds, options.run.reference_rate, options.run.frames_per_second);
    std::printf("%-18s  %6s  %12s  %12s  %16s  %16s  %8s\n", "", "lag ms", "MSE now", "MSE as shown", "second diff. +",
                "of the error", "viewer s");
    json rows = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        double const machine = machine_factor(*scene, options.run, options.costs);
        std::vector<Picture> const present = late_reference(*scene, options, 0);
        for (double const lag_ms : study.lags_ms) {
            RunParameters run = options.run;
            run.lag_seconds = 1e-3 * lag_ms;
            ShownPictures shown = show_method(*scene, "framelet", run, machine, options.costs);
            Lagging const late{lag_ms, late_reference(*scene, options, run.lag_seconds), std::move(shown.pictures)};
            double const beyond =
                mean_squared_second_difference(late.shown) - mean_squared_second_difference(late.reference);
            double const of_error = mean_squared_second_difference(late.shown, late.reference);
            double const now = mean_error(late.shown, present);
            double const as_shown = mean_error(late.shown, late.reference);
            std::printf("%-18s  %6.0f  %12.3e  %12.3e  %16.3e  %16.3e  %8.4f\n", scene->name.c_str(), lag_ms, now,
                        as_shown, beyond, of_error, shown.run.cpu.viewer());
            std::fflush(stdout);
            rows.push_back({{"scene", scene->name},
                            {"lag_ms", lag_ms},
                            {"mse_now", now},
                            {"mse_as_shown", as_shown},
                            {"second_difference_beyond_reference", beyond},
                            {"second_difference_of_error", of_error},
                            {"viewer_seconds", shown.run.cpu.viewer()}});
            if (!options.charts.empty()) {
                write_pictures(scene->name, late, options.charts);
            }
        }
    }
    return rows;
}

} // namespace framelet::bench
