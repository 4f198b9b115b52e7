#include "tests/evaluation/stability.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "scenes/scene_table.h"
#include "tests/evaluation/cycle_log.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/scene_events.h"
#include "tests/evaluation/settling.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Factor of its final level within which an error counts as settled.
constexpr double settled_factor = 2;

/// Figures of an error over time, and of the scheduler's cycles meanwhile, from an event to `until`.
json event_figures(std::vector<double> const& times, std::vector<double> const& errors,
                   std::vector<CycleEntry> const& cycles, double event, double until) {
    // The picture at the event's own time shows the state after it and is not there yet: it counts to what comes after
    // the event.
    auto const first = std::ranges::lower_bound(times, event - 1e-9) - times.begin();
    auto const last = std::ranges::lower_bound(times, until - 1e-9) - times.begin();
    auto const part = [&](std::vector<double> const& all) {
        return std::span(all).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first));
    };
    Settling const settling = measure_settling(part(times), part(errors), event, settled_factor);
    json figures{{"seconds", event},
                 {"final_mse", settling.final_level},
                 {"peak_mse", settling.peak},
                 {"overshoot", settling.overshoot}};
    if (settling.first) {
        figures["first_seconds"] = *settling.first;
    }
    if (settling.settled) {
        figures["settled_seconds"] = *settling.settled;
        figures["settled_cycles"] = std::ranges::count_if(cycles, [&](CycleEntry const& entry) {
            return entry.start >= event && entry.start < event + *settling.settled;
        });
    }
    return figures;
}

json run_batch(Subject const& subject, std::vector<double> const& events, CostTable const& costs) {
    RunParameters const& parameters = subject.run;
    auto const method = make_method("framelet", method_setup(parameters, subject.machine, costs));
    CycleLog log;
    std::vector<double> times, errors;
    run_method(
        *subject.scene, *method, parameters, subject.machine,
        [&](std::size_t index, Picture const& shown, double) {
            times.push_back(reference_time(parameters, index));
            errors.push_back(mean_squared_error(shown, subject.reference.picture(index)));
        },
        [&](double start, ServerStep const& step) { log.add(start, *method->scheduler(), step.samples); });
    Conservation const conservation = measure_conservation(log.entries(), 0, parameters.seconds);
    json result{{"scene", subject.scene->name},
                {"batch", parameters.batch_framelets},
                {"conservation",
                 {{"samples", conservation.samples},
                  {"budget", conservation.budget},
                  {"share", conservation.samples / std::max(conservation.budget, 1.0)},
                  {"largest_share", conservation.largest_share}}},
                {"mse", errors}};
    for (std::size_t i = 0; i < events.size(); ++i) {
        double const until = i + 1 < events.size() ? events[i + 1] : parameters.seconds;
        result["events"].push_back(event_figures(times, errors, log.entries(), events[i], until));
    }
    return result;
}

} // namespace

json measure_stability(StudyOptions const& study, std::vector<std::size_t> const& batches) {
    std::printf("settled: error within %gx of its final level\n"
                "samples: rendered, over what there was time for; worst: of a tenth of a second\n",
                settled_factor);
    FigureTable const table({{"scene", "/scene", -9},
                             {"batch", "/batch", 5, 0},
                             {"event", "/event/seconds", 6},
                             {"peak mse", "/event/peak_mse", 9, 2, 1, true},
                             {"final mse", "/event/final_mse", 9, 2, 1, true},
                             {"first ms", "/event/first_seconds", 8, 0, 1e3},
                             {"settled ms", "/event/settled_seconds", 10, 0, 1e3},
                             {"cycles", "/event/settled_cycles", 7, 0},
                             {"over", "/event/overshoot", 6, 1},
                             {"samples", "/conservation/share", 7, 3},
                             {"worst", "/conservation/largest_share", 7, 3}});
    json result{{"viewport", {study.run.viewport.width, study.run.viewport.height}},
                {"reference_rate", study.run.reference_rate},
                {"samples_per_pixel_and_second", study.run.frames_per_second},
                {"factor", settled_factor},
                {"runs", json::array()}};
    for (std::filesystem::path const& file : study.scenes) {
        std::string const name = file.stem().string();
        std::vector<double> const events = events_of(name).times;
        if (events.empty()) {
            throw InputError("nothing jumps or stops in the scene '" + name + "'");
        }
        StudyOptions of_scene = study;
        of_scene.run.seconds = std::ranges::find(scene_table(), name, &SceneEntry::name)->duration;
        Subject subject = prepare(file, of_scene);
        for (std::size_t const batch : batches) {
            subject.run.batch_framelets = batch;
            json const& run = result["runs"].emplace_back(run_batch(subject, events, study.costs));
            for (json const& event : run["events"]) {
                json row = run;
                row["event"] = event;
                table.print(row);
            }
        }
    }
    return result;
}

} // namespace framelet::bench
