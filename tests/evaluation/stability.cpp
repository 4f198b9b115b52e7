#include "tests/evaluation/stability.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "scenes/scene_table.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/cycle_log.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/scene_events.h"
#include "tests/evaluation/settling.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// The still time that hunting is looked for in: the end of an interval, when the error should have settled.
constexpr double hunting_share = 0.5;

struct EventRecord {
    double time = 0, until = 0;
    Settling settling;
    std::size_t settling_cycles = 0; ///< that began until it had settled
    Hunting hunting;
};

struct StabilityRun {
    std::size_t batch = 0;
    std::vector<double> times, errors;
    std::vector<CycleEntry> cycles;
    std::vector<EventRecord> events;
    Conservation conservation;
};

StabilityRun run_batch(Subject const& subject, std::vector<double> const& events, StabilityOptions const& options,
                       CostTable const& costs) {
    RunParameters const& parameters = subject.run;
    StabilityRun result;
    result.batch = parameters.batch_framelets;
    auto const method = make_method("framelet", method_setup(parameters, subject.machine, costs));
    CycleLog log;
    run_method(
        *subject.scene, *method, parameters, subject.machine,
        [&](std::size_t index, Picture const& shown, double) {
            result.times.push_back(reference_time(parameters, index));
            result.errors.push_back(mean_squared_error(shown, subject.reference.picture(index)));
        },
        [&](double start, ServerStep const& step) { log.add(start, *method->scheduler(), step.samples); });
    result.cycles = log.entries();
    result.conservation = measure_conservation(result.cycles, 0, parameters.seconds);
    for (std::size_t i = 0; i < events.size(); ++i) {
        EventRecord event{.time = events[i],
                          .until = i + 1 < events.size() ? events[i + 1] : parameters.seconds,
                          .settling = {},
                          .settling_cycles = 0,
                          .hunting = {}};
        // The picture of the event's own moment is not there yet: it belongs to what comes after it.
        auto const first = std::ranges::lower_bound(result.times, event.time - 1e-9) - result.times.begin();
        auto const last = std::ranges::lower_bound(result.times, event.until - 1e-9) - result.times.begin();
        auto const part = [&](std::vector<double> const& all) {
            return std::span(all).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first));
        };
        event.settling = measure_settling(part(result.times), part(result.errors), event.time, options.factor);
        event.hunting =
            measure_hunting(result.cycles, event.until - hunting_share * (event.until - event.time), event.until);
        event.settling_cycles =
            static_cast<std::size_t>(std::ranges::count_if(result.cycles, [&event](CycleEntry const& entry) {
                return entry.start >= event.time &&
                       entry.start < event.time + event.settling.settled.value_or(INFINITY);
            }));
        result.events.push_back(event);
    }
    return result;
}

json to_json(StabilityRun const& run) {
    json result{{"batch", run.batch},
                {"conservation",
                 {{"samples", run.conservation.samples},
                  {"budget", run.conservation.budget},
                  {"largest_share", run.conservation.largest_share}}},
                {"mse", run.errors}};
    auto const or_null = [](std::optional<double> value) { return value ? json(*value) : json(); };
    for (EventRecord const& event : run.events) {
        result["events"].push_back({{"seconds", event.time},
                                    {"final_mse", event.settling.final_level},
                                    {"peak_mse", event.settling.peak},
                                    {"first_seconds", or_null(event.settling.first)},
                                    {"settled_seconds", or_null(event.settling.settled)},
                                    {"settled_cycles", event.settling.settled ? json(event.settling_cycles) : json()},
                                    {"overshoot", event.settling.overshoot},
                                    {"hunting",
                                     {{"cycles", event.hunting.cycles},
                                      {"changed_share", event.hunting.changed_share},
                                      {"price_octaves", event.hunting.price_octaves}}}});
    }
    return result;
}

void print_head(StabilityOptions const& options) {
    std::printf("settled: error within %gx of its final level; hunting: the last half before the next event\n",
                options.factor);
    std::printf("%-9s %5s %6s %9s %9s %8s %10s %7s %6s %7s %9s %9s\n", "scene", "batch", "event", "peak mse",
                "final mse", "first ms", "settled ms", "cycles", "over", "later", "tiling %", "price oct");
}

void print(StabilityRun const& run, std::string const& scene) {
    auto const milliseconds = [](std::optional<double> seconds) {
        char text[32];
        std::snprintf(text, sizeof(text), "%.0f", 1e3 * seconds.value_or(0));
        return seconds ? std::string(text) : std::string("never");
    };
    for (EventRecord const& event : run.events) {
        std::string const cycles = event.settling.settled ? std::to_string(event.settling_cycles) : "-";
        std::printf("%-9s %5zu %6.2f %9.2e %9.2e %8s %10s %7s %6.1f %7zu %9.1f %9.3f\n", scene.c_str(), run.batch,
                    event.time, event.settling.peak, event.settling.final_level,
                    milliseconds(event.settling.first).c_str(), milliseconds(event.settling.settled).c_str(),
                    cycles.c_str(), event.settling.overshoot, event.hunting.cycles, 100 * event.hunting.changed_share,
                    event.hunting.price_octaves);
    }
    std::printf("%-9s %5zu samples rendered / what there was time for: %.3f, worst tenth of a second %.3f\n",
                scene.c_str(), run.batch, run.conservation.samples / std::max(run.conservation.budget, 1.0),
                run.conservation.largest_share);
    std::fflush(stdout); // whoever reads a pipe wants to see it grow
}

/// A vertical line at each event, from the least to the greatest value.
void mark_events(std::vector<double> const& events, Curves& chart) {
    double least = INFINITY, greatest = 0;
    for (Curve const& curve : chart.curves) {
        for (double const y : curve.y) {
            least = y > 0 ? std::min(least, y) : least;
            greatest = std::max(greatest, y);
        }
    }
    Curve marks{"event", {}, {}};
    for (double const event : events) {
        marks.x.insert(marks.x.end(), {event, event, event});
        marks.y.insert(marks.y.end(), {least, greatest, NAN});
    }
    chart.curves.push_back(std::move(marks));
}

void draw_charts(std::string const& scene, std::vector<StabilityRun> const& runs, std::vector<double> const& events,
                 std::filesystem::path const& folder) {
    std::filesystem::create_directories(folder);
    Curves errors{.title = scene + ": error over time",
                  .x_title = "seconds",
                  .y_title = "mean squared error",
                  .log_y = true,
                  .drawn = Drawn::lines,
                  .curves = {}};
    Curves tilings{.title = scene + ": patches of the tiling that a cycle changes",
                   .x_title = "seconds",
                   .y_title = "share of the tiling [%]",
                   .drawn = Drawn::lines,
                   .curves = {}};
    for (StabilityRun const& run : runs) {
        std::string const name = std::to_string(run.batch) + " framelets";
        errors.curves.push_back({name, run.times, run.errors});
        Curve changes{name, {}, {}};
        for (CycleEntry const& entry : run.cycles) {
            if (entry.start >= 0) {
                changes.x.push_back(entry.start);
                changes.y.push_back(100 * static_cast<double>(entry.changed_patches) /
                                    static_cast<double>(std::max<std::size_t>(entry.patches, 1)));
            }
        }
        if (!changes.x.empty()) {
            tilings.curves.push_back(std::move(changes));
        }
    }
    mark_events(events, errors);
    mark_events(events, tilings);
    draw(errors, folder / ("stability-" + scene + "-error"));
    draw(tilings, folder / ("stability-" + scene + "-tiling"));
}

} // namespace

json measure_stability(StabilityOptions const& options, StudyOptions const& study) {
    json result{{"viewport", {study.run.viewport.width, study.run.viewport.height}},
                {"reference_rate", study.run.reference_rate},
                {"samples_per_pixel_and_second", study.run.frames_per_second},
                {"factor", options.factor},
                {"scenes", json::array()}};
    print_head(options);
    for (std::filesystem::path const& file : study.scenes) {
        std::string const name = file.stem().string();
        std::vector<double> const events = events_of(name).times;
        if (events.empty()) {
            throw InputError("nothing jumps or stops in the scene '" + name + "'");
        }
        StudyOptions of_scene = study;
        of_scene.run.seconds = std::ranges::find(scene_table(), name, &SceneEntry::name)->duration;
        Subject subject = prepare(file, of_scene);
        std::vector<StabilityRun> runs;
        json figures{{"scene", name}, {"events", events}, {"runs", json::array()}};
        for (std::size_t const batch : options.batches) {
            subject.run.batch_framelets = batch;
            runs.push_back(run_batch(subject, events, options, study.costs));
            print(runs.back(), name);
            figures["runs"].push_back(to_json(runs.back()));
        }
        result["scenes"].push_back(std::move(figures));
        if (!study.charts.empty()) {
            draw_charts(name, runs, events, study.charts);
        }
    }
    return result;
}

} // namespace framelet::bench
