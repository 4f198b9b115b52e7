#include "tests/evaluation/live/scale.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <thread>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/live/live.h"
#include "tests/evaluation/live/live_frames.h"
#include "tests/evaluation/processors.h"
#include "tests/loopback/metrics_page.h"
#include "tests/loopback/process.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// The picture and the machine for which it is measured what of a server's work one thread does alone.
RunParameters large_run() {
    RunParameters run;
    run.viewport = {1920, 1080};
    run.seconds = 0.3;
    run.frames_per_second = 25;
    return run;
}

/// What has been used so far.
struct Used {
    double rays = 0, worker_paths = 0;
    double server = 0, network = 0, workers = 0; ///< processor seconds
};

/// Processor seconds of a process's first thread, which has a server's connections.
double cpu_of_first_thread(pid_t pid) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) + "/schedstat");
    double nanoseconds = 0;
    in >> nanoseconds;
    return 1e-9 * nanoseconds;
}

/// A run's costs, after a while in which the picture is built up.
Used run(ScaleOptions const& options, std::string const& light, int workers) {
    test::ServerProcess server(options.scene.string(), {"--light", light, "--threads", "1", "--metrics", "0"});
    std::string const metrics = test::metrics_address(server);
    auto const page = [&] { return test::ask(metrics, "/metrics").body(); };
    std::vector<std::unique_ptr<test::Process>> helpers;
    for (int i = 0; i < workers; ++i) {
        helpers.push_back(std::make_unique<test::Process>(
            FRAMELET_SERVER,
            std::vector<std::string>{options.scene.string(), "--work-for", server.address(), "--threads", "1"}));
    }
    if (!test::eventually([&] { return test::metric(page(), "framelet_workers") == workers; })) {
        throw ConnectionError("the workers do not join: " + helpers.front()->errors());
    }
    Viewport const viewport = options.viewport;
    test::Process viewer(FRAMELET_CLIENT,
                         {server.address(), "--size",
                          std::to_string(viewport.width) + "x" + std::to_string(viewport.height), "--rate", "10",
                          "--duration", std::to_string(options.seconds + build_up_seconds + 60)});
    std::this_thread::sleep_for(std::chrono::duration<double>(build_up_seconds));
    auto const used = [&] {
        std::string const text = page();
        Used now{test::metric(text, "framelet_rays_total"), test::metric(text, "framelet_worker_paths_total"),
                 cpu_of(server.process().pid()), cpu_of_first_thread(server.process().pid())};
        for (auto const& helper : helpers) {
            now.workers += cpu_of(helper->pid());
        }
        return now;
    };
    Used const before = used();
    std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
    Used const after = used();
    if (!(after.rays > before.rays)) {
        throw ConnectionError("nothing was rendered: " + viewer.errors());
    }
    return {after.rays - before.rays, after.worker_paths - before.worker_paths, after.server - before.server,
            after.network - before.network, after.workers - before.workers};
}

json row_of(int workers, Used const& used, double alone, double seconds) {
    double const cpu = (used.server + used.workers) / used.rays;
    std::printf("%7d %10.0f %11.2f %8.2f %8.2f\n", workers, used.rays / seconds, 1e6 * cpu,
                alone > 0 ? cpu / alone : 1.0, used.worker_paths / used.rays);
    return {{"workers", workers},
            {"samples_per_second", used.rays / seconds},
            {"cpu_us_a_sample", 1e6 * cpu},
            {"of_one_process", alone > 0 ? cpu / alone : 1.0},
            {"worker_share", used.worker_paths / used.rays}};
}

/// Costs of a run with workers. `viewers_network`: processor seconds that a run without took for the viewer; `serial`:
/// what one thread of the server does alone for a sample, seconds.
WorkCosts costs_of(Used const& used, double viewers_network, double serial) {
    WorkCosts costs;
    costs.path = used.workers / used.worker_paths;
    double const own = (used.rays - used.worker_paths) * costs.path;
    costs.network = std::max(used.network - viewers_network, 0.0) / used.worker_paths;
    costs.home = std::max(used.server - used.network - own, 0.0) / used.rays;
    costs.serial = std::min(serial, costs.home);
    return costs;
}

constexpr std::array ranks{1, 2, 4, 8, 16, 32, 64, 128};

json predict(WorkCosts const& costs, std::string const& name, Curves& chart) {
    json rows = json::array();
    for (double const gigabits : {10.0, 100.0}) {
        Curve curve{name + ", " + std::to_string(static_cast<int>(gigabits)) + " Gbit/s", {}, {}};
        for (int const count : ranks) {
            Growth const found = growth(costs, {count, 32, 1e9 * gigabits});
            curve.x.push_back(count);
            curve.y.push_back(found.efficiency);
            std::printf("%9.1f %9.0f %7d %12.1f %10.2f   %s\n", 1e6 * costs.path, gigabits, count,
                        found.samples_per_second / 1e6, found.efficiency, found.end.c_str());
            rows.push_back({{"path_us", 1e6 * costs.path},
                            {"gigabits", gigabits},
                            {"ranks", count},
                            {"samples_per_second", found.samples_per_second},
                            {"efficiency", found.efficiency},
                            {"end", found.end}});
        }
        chart.curves.push_back(std::move(curve));
    }
    return rows;
}

} // namespace

Growth growth(WorkCosts const& costs, Cluster const& cluster) {
    double const all = cluster.ranks * cluster.cores / costs.path;
    double const unbounded = std::numeric_limits<double>::infinity();
    auto const rate = [&](double seconds, double at_once) { return seconds > 0 ? at_once / seconds : unbounded; };
    std::array<std::pair<double, char const*>, 5> const parts{
        {{all, "the workers"},
         {rate(costs.home, cluster.cores), "the server's processors"},
         {rate(costs.network, 1), "the thread of the connections"},
         {rate(costs.serial, 1), "the plan"},
         {cluster.bits_per_second / 8 / bytes_a_path, "the link"}}};
    auto const least = *std::ranges::min_element(parts, {}, [](auto const& part) { return part.first; });
    return {least.first, least.first / all, least.second};
}

json measure_scale(ScaleOptions const& options) {
    std::printf("%s, %dx%d, light by paths, one thread each\n", options.scene.stem().c_str(), options.viewport.width,
                options.viewport.height);
    std::printf("workers  samples/s  us a sample   of one  by workers\n");
    json measured = json::array();
    double alone = 0, viewers_network = 0;
    Used best;
    for (int const workers : options.workers) {
        Used const used = run(options, "reference", workers);
        measured.push_back(row_of(workers, used, alone, options.seconds));
        if (workers == 0) {
            alone = used.server / used.rays;
            viewers_network = used.network;
        } else if (best.worker_paths == 0) { // with more they share processors on a small machine
            best = used;
        }
    }
    json out{{"scene", options.scene.stem().string()}, {"measured", measured}};
    if (best.worker_paths == 0) {
        return out;
    }
    auto const scene = load_bench_scene(options.scene);
    double const serial = measure_server(*scene, large_run(), options.costs, {1, 2}).serial();
    WorkCosts const costs = costs_of(best, viewers_network, serial);
    std::printf(
        "a sample costs %.2f us for its path, %.3f at the server, %.4f of its thread of connections, %.4f of the "
        "one that plans\n",
        1e6 * costs.path, 1e6 * costs.home, 1e6 * costs.network, 1e6 * costs.serial);
    out["costs_us"] = {{"path", 1e6 * costs.path},
                       {"home", 1e6 * costs.home},
                       {"network", 1e6 * costs.network},
                       {"serial", 1e6 * costs.serial}};
    Curves chart{"Efficiency of workers with 32 cores, by the costs measured",
                 "workers",
                 "share of their paths shown",
                 true,
                 false,
                 {}};
    std::printf("path (us)  Gbit/s   ranks  Msamples/s efficiency   ended by\n");
    json model = predict(costs, "as measured", chart);
    WorkCosts dear = costs;
    dear.path = 20e-6;
    for (json const& row : predict(dear, "20 us a path", chart)) {
        model.push_back(row);
    }
    out["model"] = model;
    if (!options.charts.empty()) {
        draw(chart, options.charts / "scale");
    }
    return out;
}

} // namespace framelet::bench
