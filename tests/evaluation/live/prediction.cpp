#include "tests/evaluation/live/prediction.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// A session goes by what it costs, and costs by how it goes.
constexpr int calibrations = 3;

/// The machine as fast as the calibrated one: a core of it.
RunParameters on_one_core(BenchScene& scene, RunParameters run, CostTable const& costs) {
    run.frames_per_second = 1;
    run.frames_per_second = machine_factor(scene, run, costs);
    return run;
}

/// Rates of what is measured, in the time in which nothing is built up any more.
json rates_of(RunResult const& run, RunParameters const& parameters) {
    double const seconds = parameters.seconds - build_up_seconds;
    double bytes = 0;
    for (RunResult::Delivery const& delivery : run.deliveries) {
        bytes += delivery.sent >= build_up_seconds ? delivery.bytes : 0;
    }
    auto const pictures = std::ranges::count_if(run.displayed, [](double when) { return when >= build_up_seconds; });
    return {{"kB_per_second", 1e-3 * bytes / seconds},
            {"pictures_per_second", static_cast<double>(pictures) / seconds},
            {"samples_per_second", static_cast<double>(run.sent_samples) / parameters.seconds},
            {"server_cores", run.cpu.server() / parameters.seconds},
            {"viewer_cores", run.cpu.viewer() / parameters.seconds}};
}

double ratio(json const& figures, char const* amount, char const* count) {
    return figures[amount].get<double>() / std::max(figures[count].get<double>(), 1e-9);
}

/// What is measured in these stages becomes what the processes took of which they are the whole work: `processes` over
/// `charged`, each for one of what they make.
void fit(std::initializer_list<SessionTimes::Stage*> stages, double processes, double charged) {
    double clocked_sum = 0, charged_sum = 0;
    for (SessionTimes::Stage const* const stage : stages) {
        clocked_sum += stage->measured;
        charged_sum += stage->charged;
    }
    if (clocked_sum > 0 && charged > 0) {
        double const factor = processes / charged * charged_sum / clocked_sum;
        std::ranges::for_each(stages, [factor](SessionTimes::Stage* stage) { stage->measured *= factor; });
    }
}

/// The table for the machine as it was: how the stages share their time is clocked in a session like the measured one,
/// how much they take together is what the processes took.
CostTable calibrated(BenchScene& scene, std::string const& method, RunParameters run, CostTable const& costs,
                     json const& measured) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    SessionTimes times;
    run.times = &times;
    auto const session = make_method(method, method_setup(run, 1, costs));
    json const figures = rates_of(run_method(scene, *session, run, 1, [](std::size_t, Picture const&, double) {}), run);
    fit({&times.plan, &times.render, &times.learn, &times.encode},
        ratio(measured, "server_cores", "samples_per_second"), ratio(figures, "server_cores", "samples_per_second"));
    fit({&times.decode, &times.insert, &times.paint}, ratio(measured, "viewer_cores", "pictures_per_second"),
        ratio(figures, "viewer_cores", "pictures_per_second"));
    return bench::calibrated(costs, times);
}

} // namespace

json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options, json const& measured,
                  std::vector<ComparedMoment> const& moments) {
    RunParameters run;
    run.viewport = options.viewport;
    run.start = measured["start_seconds"];
    run.seconds = options.seconds;
    run.begins_empty = true;
    for (ComparedMoment const& moment : moments) {
        run.reference_times.push_back(moment.time - run.start);
    }
    run.link = options.link;
    CostTable costs = options.costs;
    for (int i = 0; i < calibrations; ++i) {
        run = on_one_core(scene, run, costs);
        costs = calibrated(scene, method, run, costs, measured);
    }
    run = on_one_core(scene, run, costs);
    double mse = 0;
    auto const session = make_method(method, method_setup(run, 1, costs));
    RunResult const result = run_method(scene, *session, run, 1, [&](std::size_t i, Picture const& shown, double) {
        mse += mean_squared_error(shown, moments[i].reference) / static_cast<double>(moments.size());
    });
    json figures = rates_of(result, run);
    figures["mse"] = mse;
    figures["psnr"] = psnr_from_mse(mse);
    figures["costs"] = to_json(costs);
    return figures;
}

} // namespace framelet::bench
