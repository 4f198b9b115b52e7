#include "tests/evaluation/live/crowd.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/live/live.h"
#include "tests/evaluation/live/live_frames.h"
#include "tests/loopback/process.h"
#include "tests/session/raw_viewer.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Figures of one viewer, from when it has built up its picture to its end.
json viewer_figures(std::vector<LiveFrame> const& frames) {
    std::vector<double> gaps;
    double changed = 0;
    auto const first = std::ranges::find_if(frames, [&frames](LiveFrame const& frame) {
        return frame.seconds >= frames.front().seconds + build_up_seconds;
    });
    if (frames.end() - first < 2) {
        throw ConnectionError("a viewer showed " + std::to_string(frames.size()) + " pictures");
    }
    for (auto frame = first + 1; frame != frames.end(); ++frame) {
        gaps.push_back(frame->seconds - (frame - 1)->seconds);
        changed += frame->changed ? 1 : 0;
    }
    double const span = frames.back().seconds - first->seconds;
    return {{"pictures_per_second", changed / span},
            {"gap_p99_ms", 1e3 * percentile(gaps, 0.99)},
            {"kB_per_second", (frames.back().bytes - first->bytes) / span / 1e3}};
}

/// Summary of all viewers: the slowest and the median rate of pictures, the longest gap, all bytes.
json summary_of(json const& viewers, double server_busy) {
    std::vector<double> rates, gaps;
    double bytes = 0;
    for (json const& viewer : viewers) {
        rates.push_back(viewer["pictures_per_second"]);
        gaps.push_back(viewer["gap_p99_ms"]);
        bytes += viewer["kB_per_second"].get<double>();
    }
    return {{"least_pictures_per_second", std::ranges::min(rates)},
            {"pictures_per_second", percentile(rates, 0.5)},
            {"gap_p99_ms", std::ranges::max(gaps)},
            {"kB_per_second", bytes},
            {"server_busy", server_busy}};
}

/// A viewer that has said what it wants to see, and reads nothing of it.
std::unique_ptr<RawViewer> stalled_viewer(std::uint16_t port, Viewport viewport) {
    auto viewer = std::make_unique<RawViewer>(port);
    viewer->send(CameraUpdate{{1, Camera{}, viewport}, 0});
    return viewer;
}

/// The niceness with which so many viewers get together about as much of the processors as a server whose niceness is
/// 0: each step is worth a quarter. Else they would leave it next to nothing, which has a machine of its own in
/// earnest.
int niceness_of_each(int viewers) {
    constexpr int most = 19;
    return std::min(most, static_cast<int>(std::lround(std::log(viewers) / std::log(1.25))));
}

json run_crowd(BenchScene const& scene, CrowdOptions const& options, bool with_stalled) {
    test::TemporaryFolder const folder;
    char stops[40];
    std::snprintf(stops, sizeof stops, "%.9g", std::log2(static_cast<double>(scene.exposure)));
    test::ServerProcess server(scene.file.string(),
                               {"--exposure", stops, "--insecure", "--session-memory", "1000000", "--nice", "0",
                                "--max-sessions", std::to_string(options.viewers + 1)});
    std::string const& address = server.address();
    std::unique_ptr<RawViewer> stalled;
    if (with_stalled) {
        stalled = stalled_viewer(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))),
                                 options.viewport);
    }
    std::string const size = std::to_string(options.viewport.width) + "x" + std::to_string(options.viewport.height);
    auto const frames_file = [&](int viewer) { return folder.path() / (std::to_string(viewer) + ".jsonl"); };
    std::vector<std::string> camera;
    if (scene.scene_camera != none) {
        camera = {"--camera", folder.write("camera.json", json{{"scene_camera", scene.scene_camera}}.dump())};
    }
    std::vector<std::unique_ptr<test::Process>> clients;
    for (int i = 0; i < options.viewers; ++i) {
        std::vector<std::string> words{"-n",
                                       std::to_string(niceness_of_each(options.viewers)),
                                       FRAMELET_CLIENT,
                                       address,
                                       "--size",
                                       size,
                                       "--duration",
                                       std::to_string(options.seconds),
                                       "--rate",
                                       "60",
                                       "--frames",
                                       frames_file(i).string()};
        words.insert(words.end(), camera.begin(), camera.end());
        clients.push_back(std::make_unique<test::Process>("/usr/bin/nice", words));
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(build_up_seconds));
    double const before = cpu_of(server.process().pid());
    auto const begun = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds - build_up_seconds - 0.2));
    std::chrono::duration<double> const watched = std::chrono::steady_clock::now() - begun;
    double const cores = (cpu_of(server.process().pid()) - before) / watched.count();
    json viewers = json::array();
    for (int i = 0; i < options.viewers; ++i) {
        test::Process& client = *clients[static_cast<std::size_t>(i)];
        if (int const code = client.wait(std::chrono::seconds(120)); code != 0) {
            throw ConnectionError("a viewer ended with " + std::to_string(code) + ": " + client.errors());
        }
        viewers.push_back(viewer_figures(read_frames(frames_file(i))));
    }
    json const all = summary_of(viewers, cores / std::max(1u, std::thread::hardware_concurrency()));
    return {{"viewers", viewers}, {"all", all}};
}

void print_rows(FigureTable const& table, json const& run, std::string const& title) {
    int number = 0;
    for (json row : run["viewers"]) {
        row["title"] = "viewer " + std::to_string(++number);
        table.print(row);
    }
    json row = run["all"];
    row["title"] = title;
    table.print(row);
}

} // namespace

json measure_crowd(BenchScene const& scene, CrowdOptions const& options) {
    std::printf("%s, %dx%d, %g s, %d viewers\n", scene.name.c_str(), options.viewport.width, options.viewport.height,
                options.seconds, options.viewers);
    FigureTable const table({{"viewer", "/title", -22},
                             {"pict/s", "/pictures_per_second", 7, 1},
                             {"least", "/least_pictures_per_second", 7, 1},
                             {"gap ms", "/gap_p99_ms", 6, 0},
                             {"kB/s", "/kB_per_second", 7, 0},
                             {"server", "/server_busy", 6}});
    json figures{{"scene", scene.name}, {"size", {options.viewport.width, options.viewport.height}}};
    figures["alone"] = run_crowd(scene, options, false);
    print_rows(table, figures["alone"], "all");
    if (options.stalled) {
        figures["with_stalled"] = run_crowd(scene, options, true);
        print_rows(table, figures["with_stalled"], "all, beside a stalled");
    }
    return figures;
}

} // namespace framelet::bench
