#include "tests/evaluation/processors.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "common/error.h"
#include "tests/evaluation/charts/charts.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr SessionTimes::Stage SessionTimes::*stages[] = {&SessionTimes::plan, &SessionTimes::render,
                                                         &SessionTimes::learn, &SessionTimes::encode};
constexpr StageCost ServerCosts::*costs_of_stages[] = {&ServerCosts::plan, &ServerCosts::render, &ServerCosts::learn,
                                                       &ServerCosts::encode};
constexpr char const* stage_names[] = {"plan", "render", "learn", "encode"};

/// Seconds that each stage took for a sample that was sent.
SessionTimes run_with(int threads, BenchScene& scene, RunParameters run, CostTable const& costs) {
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    SessionTimes times;
    run.times = &times;
    double const machine = machine_factor(scene, run, costs);
    auto const session = make_method("framelet", method_setup(run, machine, costs));
    run_method(scene, *session, run, machine, [](std::size_t, Picture const&, double) {});
    if (times.samples == 0) {
        throw InputError("nothing was sent in so short a time");
    }
    return times;
}

} // namespace

StageCost stage_cost(std::vector<int> const& threads, std::vector<double> const& seconds) {
    FRAMELET_CHECK(threads.size() == seconds.size() && !threads.empty());
    double const count = static_cast<double>(threads.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < threads.size(); ++i) {
        double const share = 1.0 / threads[i];
        x += share;
        y += seconds[i];
        xx += share * share;
        xy += share * seconds[i];
    }
    double const spread = count * xx - x * x;
    FRAMELET_CHECK(spread > 0);
    double const parallel = std::max((count * xy - x * y) / spread, 0.0);
    double const serial = (y - parallel * x) / count;
    return serial >= 0 ? StageCost{serial, parallel} : StageCost{0, xy / xx};
}

double seconds_with(ServerCosts const& costs, int threads) {
    double const share = 1.0 / threads;
    double const chain = costs.learn.serial + costs.encode.serial; // one batch is learnt, then encoded
    double const finishing = share * (costs.learn.parallel + costs.encode.parallel);
    double const overlapped = std::max(chain + finishing, share * (costs.render.parallel + chain) + finishing);
    return costs.plan.serial + share * costs.plan.parallel + overlapped;
}

ServerCosts measure_server(BenchScene& scene, RunParameters const& run, CostTable const& costs,
                           std::vector<int> const& threads, json* rows) {
    std::vector<std::vector<double>> seconds(std::size(stages));
    for (int const count : threads) {
        SessionTimes const times = run_with(count, scene, run, costs);
        for (std::size_t i = 0; i < seconds.size(); ++i) {
            seconds[i].push_back((times.*stages[i]).measured / static_cast<double>(times.samples));
        }
    }
    std::printf("%s, %dx%d, a machine of %g samples a pixel and second; ns a sample\nstage   ", scene.name.c_str(),
                run.viewport.width, run.viewport.height, run.frames_per_second);
    for (int const count : threads) {
        std::printf(" %3d thread%s", count, count == 1 ? " " : "s");
    }
    std::printf("   by one alone\n");
    ServerCosts found;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        StageCost const cost = found.*costs_of_stages[i] = stage_cost(threads, seconds[i]);
        std::printf("%-8s", stage_names[i]);
        for (double const each : seconds[i]) {
            std::printf(" %11.1f", 1e9 * each);
        }
        std::printf(" %14.1f\n", 1e9 * cost.serial);
        if (rows != nullptr) {
            rows->push_back({{"stage", stage_names[i]},
                             {"seconds_a_sample", seconds[i]},
                             {"serial", cost.serial},
                             {"parallel", cost.parallel}});
        }
    }
    found.render = {0, found.render.serial + found.render.parallel}; // one parallel loop: the rest is noise of so much
    return found;
}

json measure_processors(BenchScene& scene, RunParameters const& run, CostTable const& costs,
                        std::vector<int> const& threads, std::filesystem::path const& charts) {
    json rows = json::array(), growth = json::array();
    ServerCosts const found = measure_server(scene, run, costs, threads, &rows);
    Curve rates{"framelet", {}, {}}, ideal{"no serial work", {}, {}};
    std::printf("threads  Msamples/s  of no serial work\n");
    for (int count = 1; count <= 64; count *= 2) {
        double const rate = 1e-6 / seconds_with(found, count);
        double const best = 1e-6 * count / seconds_with(found, 1);
        std::printf("%7d %11.1f %18.2f\n", count, rate, rate / best);
        rates.x.push_back(count);
        rates.y.push_back(rate);
        ideal.x.push_back(count);
        ideal.y.push_back(best);
        growth.push_back({{"threads", count}, {"msamples_per_second", rate}, {"efficiency", rate / best}});
    }
    if (!charts.empty()) {
        Curves const chart{"Samples for one viewer, by what the stages take",
                           "threads",
                           "million samples a second",
                           true,
                           true,
                           {rates, ideal}};
        draw(chart, charts / "limits-threads");
    }
    return {{"scene", scene.name}, {"threads", threads}, {"stages", rows}, {"growth", growth}};
}

} // namespace framelet::bench
