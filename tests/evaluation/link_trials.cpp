#include "tests/evaluation/link_trials.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/comparison.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

struct Trial {
    std::string name;
    LinkParameters link;
};

std::vector<Trial> trials_of(RunParameters const& run) {
    double const third = run.seconds / 3;
    LinkParameters base = run.link;
    base.jitter_seconds = 0;
    auto const with = [&base](double bits_per_second) {
        LinkParameters link = base;
        link.bits_per_second = bits_per_second;
        return link;
    };
    Trial steps{"steps", with(100e6)};
    steps.link.rate_steps = {{third, 1e6}, {2 * third, 20e6}};
    Trial steady{"300-kB", with(2.4e6)};
    Trial stall{"stall", with(20e6)};
    stall.link.stalls = {{third, std::min(2.0, third)}};
    Trial jitter{"jitter", with(20e6)};
    jitter.link.jitter_seconds = 0.03;
    return {steps, steady, stall, jitter};
}

constexpr double bin_seconds = 0.1;

/// Bytes a second in each tenth of a second.
Curve bytes_over_time(MethodRecord const& record, double seconds) {
    Curve curve{record.method, {}, {}};
    curve.y.resize(static_cast<std::size_t>(std::ceil(seconds / bin_seconds)));
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
        curve.x.push_back((static_cast<double>(i) + 0.5) * bin_seconds);
    }
    for (RunResult::Delivery const& delivery : record.run.deliveries) {
        auto const bin = static_cast<std::size_t>(std::max(0.0, delivery.sent / bin_seconds));
        if (bin < curve.y.size()) {
            curve.y[bin] += delivery.bytes / bin_seconds;
        }
    }
    return curve;
}

Curve queueing_over_time(MethodRecord const& record) {
    Curve curve{record.method, {}, {}};
    for (RunResult::Delivery const& delivery : record.run.deliveries) {
        curve.x.push_back(delivery.sent);
        curve.y.push_back(1e3 * delivery.queueing);
    }
    return curve;
}

double most_queueing(MethodRecord const& record, double from, double to) {
    double most = 0;
    for (RunResult::Delivery const& delivery : record.run.deliveries) {
        bool const within = delivery.sent >= from && delivery.sent < to;
        most = within ? std::max(most, delivery.queueing) : most;
    }
    return most;
}

/// The largest queueing delay from a second after the beginning of each third until its end.
json settled_queueing(MethodRecord const& record, double seconds) {
    json result = json::array();
    for (int part = 0; part < 3; ++part) {
        double const begin = part * seconds / 3;
        double const end = (part + 1) * seconds / 3;
        result.push_back(most_queueing(record, std::min(begin + 1, 0.5 * (begin + end)), end));
    }
    return result;
}

void draw_trial(Comparison const& comparison, std::string const& stem, std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    ErrorOverTime error{.title = stem + ": error over time", .series = {}};
    Curves bytes{.title = stem + ": sent",
                 .x_title = "time [s]",
                 .y_title = "bytes a second",
                 .log_y = true,
                 .points = false,
                 .curves = {}};
    Curves queue{
        .title = stem + ": queueing delay", .x_title = "time [s]", .y_title = "ms", .points = false, .curves = {}};
    for (MethodRecord const& record : comparison.records) {
        ErrorSeries series{record.method, {}, {}, record.run.displayed};
        for (std::size_t i = 0; i < record.measures.size(); ++i) {
            series.seconds.push_back(reference_time(comparison.parameters, i));
            series.mse.push_back(record.measures[i].mse);
        }
        error.series.push_back(std::move(series));
        bytes.curves.push_back(bytes_over_time(record, comparison.parameters.seconds));
        if (!record.run.deliveries.empty()) {
            queue.curves.push_back(queueing_over_time(record));
        }
    }
    draw(error, folder / (stem + "-error"));
    draw(bytes, folder / (stem + "-sent"));
    if (!queue.curves.empty()) {
        draw(queue, folder / (stem + "-queueing"));
    }
}

} // namespace

json link_trials(BenchScene& scene, Reference const& reference, StudyOptions const& options) {
    json result = json::object();
    for (Trial const& trial : trials_of(options.run)) {
        RunParameters parameters = options.run;
        parameters.link = trial.link;
        Comparison const comparison = compare_methods(scene, reference, options.methods, parameters, options.costs);
        std::printf("\n%s: %s\n", scene.name.c_str(), trial.name.c_str());
        print(comparison);
        json entry = to_json(comparison);
        for (std::size_t m = 0; m < comparison.records.size(); ++m) {
            MethodRecord const& record = comparison.records[m];
            json const queueing = settled_queueing(record, parameters.seconds);
            std::printf("%-12s queueing of each third once settled, ms: %7.1f %7.1f %7.1f\n", record.method.c_str(),
                        1e3 * queueing[0].get<double>(), 1e3 * queueing[1].get<double>(),
                        1e3 * queueing[2].get<double>());
            json& method = entry["methods"][m];
            method["settled_queueing_seconds"] = queueing;
            for (RunResult::Delivery const& delivery : record.run.deliveries) {
                method["deliveries"].push_back({delivery.sent, delivery.bytes, delivery.queueing});
            }
        }
        if (!options.charts.empty()) {
            draw_trial(comparison, scene.name + "-" + trial.name, options.charts);
        }
        result[trial.name] = std::move(entry);
    }
    return result;
}

} // namespace framelet::bench
