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

/// Number of times that the table is calibrated: a session depends on the costs, and the costs depend on how it goes.
constexpr int calibrations = 3;

/// The run on a machine as fast as one core of the calibrated one.
RunParameters on_one_core(BenchScene& scene, RunParameters run, CostTable const& costs) {
    run.frames_per_second = 1;
    run.frames_per_second = machine_factor(scene, run, costs);
    return run;
}

json rates_of(RunResult const& run, RunParameters const& parameters) {
    return {{"kB_per_second", 1e-3 * static_cast<double>(run.bytes) / parameters.seconds},
            {"pictures_per_second", static_cast<double>(run.displayed.size()) / parameters.seconds},
            {"samples_per_second", static_cast<double>(run.sent_samples) / parameters.seconds},
            {"server_cores", run.cpu.server() / parameters.seconds},
            {"viewer_cores", run.cpu.viewer() / parameters.seconds}};
}

double ratio(json const& figures, char const* amount, char const* count) {
    return figures[amount].get<double>() / std::max(figures[count].get<double>(), 1e-9);
}

double sum_of(std::initializer_list<SessionTimes::Stage*> stages, double SessionTimes::Stage::*seconds) {
    double sum = 0;
    for (SessionTimes::Stage const* const stage : stages) {
        sum += stage->*seconds;
    }
    return sum;
}

void scale(std::initializer_list<SessionTimes::Stage*> stages, double factor) {
    std::ranges::for_each(stages, [factor](SessionTimes::Stage* stage) { stage->measured *= factor; });
}

/// The table of costs for the machine as it was: how the stages share their time is clocked in a session like the
/// measured one, how much they take together is what the processes took.
CostTable calibrated(BenchScene& scene, std::string const& method, RunParameters run, CostTable const& costs,
                     json const& measured) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    SessionTimes times;
    run.times = &times;
    auto const session = make_method(method, method_setup(run, 1, costs));
    json const figures = rates_of(run_method(scene, *session, run, 1, [](std::size_t, Picture const&, double) {}), run);
    std::initializer_list<SessionTimes::Stage*> const server{&times.plan, &times.render, &times.learn, &times.encode};
    std::initializer_list<SessionTimes::Stage*> const viewer{&times.decode, &times.insert, &times.paint};
    // The server is clocked over the whole session: where little is left to be rendered later, most of what it takes is
    // for looking.
    double const clocked = sum_of(server, &SessionTimes::Stage::measured) + times.looking;
    scale(server, measured["server_seconds_per_sample"].get<double>() * static_cast<double>(times.samples) / clocked);
    // The viewer is compared in the steady part of both sessions, since later on a picture is made of more.
    scale(viewer, ratio(measured["steady"], "viewer_cores", "pictures_per_second") /
                      ratio(figures, "viewer_cores", "pictures_per_second") *
                      sum_of(viewer, &SessionTimes::Stage::charged) / sum_of(viewer, &SessionTimes::Stage::measured));
    return bench::calibrated(costs, times);
}

} // namespace

json predict_live(BenchScene& scene, std::string const& method, LiveOptions const& options, json const& measured,
                  std::vector<ComparedMoment> const& moments) {
    RunParameters run;
    run.viewport = options.viewport;
    run.start = measured["start_seconds"].get<double>() + build_up_seconds;
    run.seconds = options.seconds - build_up_seconds;
    run.clock_offset = measured["start_clock"].get<double>() + build_up_seconds;
    run.fresh_lead = build_up_seconds;
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
    json moment_mse = json::array();
    auto const session = make_method(method, method_setup(run, 1, costs));
    RunResult const result = run_method(scene, *session, run, 1, [&](std::size_t i, Picture const& shown, double) {
        double const error = mean_squared_error(shown, moments[i].reference);
        moment_mse.push_back(error);
        mse += error / static_cast<double>(moments.size());
    });
    json figures = rates_of(result, run);
    figures["mse"] = mse;
    figures["moment_mse"] = std::move(moment_mse);
    figures["psnr"] = psnr_from_mse(mse);
    figures["costs"] = to_json(costs);
    return figures;
}

} // namespace framelet::bench
