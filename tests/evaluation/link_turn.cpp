#include "tests/evaluation/link_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/picture_writer.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/comparison.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr std::array speeds{30.0, 90.0, 180.0}; ///< degrees a second
constexpr std::array round_trips{0.0, 0.05, 0.1, 0.2}; ///< seconds
constexpr std::size_t pictured = 2; ///< round trip of which pictures are shown
constexpr double longest_lag = 0.5; ///< seconds that are searched

/// Not in the middle, where some speed may just turn back.
std::size_t pictured_time(std::size_t times) {
    return times * 2 / 5;
}

struct Cell {
    double mse = 0; ///< mean over the reference times
    double lag = 0; ///< seconds
    double bytes_per_second = 0;
    double server_cpu = 0; ///< share of the time
};

/// All methods at one speed; `cells[method][round trip]`.
struct SpeedResult {
    std::vector<std::array<Cell, round_trips.size()>> cells;
    std::vector<Picture> samples; ///< of one round trip, a method each
    Picture reference_sample;
};

SpeedResult run_speed(BenchScene& scene, StudyOptions const& options) {
    std::size_t const times = reference_count(options.run);
    std::size_t const sample = pictured_time(times);
    Reference const reference = reference_of(scene, options);
    std::vector<Picture> truth;
    for (std::size_t i = 0; i < times; ++i) {
        truth.push_back(reference.picture(i));
    }
    double const machine = machine_factor(scene, options.run, options.costs);
    auto const most_lag = static_cast<std::size_t>(longest_lag * options.run.reference_rate);
    SpeedResult result;
    result.reference_sample = truth[sample];
    for (std::string const& method : options.methods) {
        auto& cells = result.cells.emplace_back();
        for (std::size_t i = 0; i < round_trips.size(); ++i) {
            RunParameters parameters = options.run;
            parameters.link.delay_seconds = 0.5 * round_trips[i];
            std::vector<Picture> shown;
            MethodRecord const record =
                record_method(scene, reference, method, parameters, machine, options.costs, &shown);
            cells[i].mse = mean_mse(record);
            cells[i].lag = static_cast<double>(picture_lag(shown, truth, most_lag)) / options.run.reference_rate;
            cells[i].bytes_per_second = static_cast<double>(record.run.bytes) / options.run.seconds;
            cells[i].server_cpu = record.run.cpu.server() / options.run.seconds;
            if (i == pictured) {
                result.samples.push_back(shown[sample]);
            }
        }
    }
    return result;
}

void print(SpeedResult const& result, StudyOptions const& options) {
    std::printf("%-18s", "round trip, ms");
    for (char const* const what : {"PSNR of the mean error, dB", "picture late by, ms", "server CPU, %", "kB/s"}) {
        std::printf(" | %-*s", static_cast<int>(9 * round_trips.size() - 1), what);
    }
    std::printf("\n%-18s", "");
    for (int block = 0; block < 4; ++block) {
        std::printf(" |");
        for (double const round_trip : round_trips) {
            std::printf("%8.0f ", 1e3 * round_trip);
        }
    }
    std::printf("\n");
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        std::printf("%-18s", options.methods[m].c_str());
        auto const block = [&](auto value) {
            std::printf(" |");
            for (Cell const& cell : result.cells[m]) {
                std::printf("%8.1f ", value(cell));
            }
        };
        block([](Cell const& cell) { return psnr_from_mse(cell.mse); });
        block([](Cell const& cell) { return 1e3 * cell.lag; });
        block([](Cell const& cell) { return 1e2 * cell.server_cpu; });
        block([](Cell const& cell) { return 1e-3 * cell.bytes_per_second; });
        std::printf("\n");
    }
}

void draw_speed(SpeedResult const& result, BenchScene const& scene, StudyOptions const& options) {
    std::filesystem::create_directories(options.charts);
    int const speed = static_cast<int>(std::lround(scene.turn.degrees_per_second));
    std::string const stem = scene.name + "-turn-" + std::to_string(speed);
    Curves chart{.title = scene.name + ": camera turning " + std::to_string(speed) + " degrees a second",
                 .x_title = "round trip [ms]",
                 .y_title = "mean squared error",
                 .log_y = true,
                 .curves = {}};
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        Curve curve{options.methods[m], {}, {}};
        for (std::size_t i = 0; i < round_trips.size(); ++i) {
            curve.x.push_back(1e3 * round_trips[i]);
            curve.y.push_back(result.cells[m][i].mse);
        }
        chart.curves.push_back(std::move(curve));
    }
    draw(chart, options.charts / stem);
    write_png(options.charts / (stem + "-side-by-side.png"), beside_reference(result.reference_sample, result.samples));
}

json to_json(SpeedResult const& result, StudyOptions const& options) {
    json figures = json::object();
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        for (std::size_t i = 0; i < round_trips.size(); ++i) {
            Cell const& cell = result.cells[m][i];
            figures[options.methods[m]].push_back({{"round_trip_seconds", round_trips[i]},
                                                   {"mse", cell.mse},
                                                   {"lag_seconds", cell.lag},
                                                   {"server_cpu", cell.server_cpu},
                                                   {"bytes_per_second", cell.bytes_per_second}});
        }
    }
    return figures;
}

} // namespace

std::size_t picture_lag(std::span<Picture const> shown, std::span<Picture const> reference, std::size_t most) {
    FRAMELET_CHECK(!shown.empty() && reference.size() >= shown.size());
    std::vector<double> errors(most + 1);
    tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t lag) {
        for (std::size_t i = 0; i < shown.size(); ++i) {
            errors[lag] += mean_squared_error(shown[i], reference[i - std::min(i, lag)]);
        }
    });
    return static_cast<std::size_t>(std::ranges::min_element(errors) - errors.begin());
}

json turn_study(BenchScene& scene, StudyOptions const& options) {
    json result = json::object();
    for (double const speed : speeds) {
        scene.turn.degrees_per_second = speed;
        SpeedResult const found = run_speed(scene, options);
        std::printf("\n%s, %dx%d, camera turning %g degrees/s, %g each way", scene.name.c_str(),
                    options.run.viewport.width, options.run.viewport.height, speed, scene.turn.reach_degrees);
        if (options.run.link.bits_per_second > 0) {
            std::printf(", link %g Mbit/s", 1e-6 * options.run.link.bits_per_second);
        }
        std::printf("\n");
        print(found, options);
        if (!options.charts.empty()) {
            draw_speed(found, scene, options);
        }
        result[std::to_string(static_cast<int>(std::lround(speed)))] = to_json(found, options);
    }
    return result;
}

} // namespace framelet::bench
