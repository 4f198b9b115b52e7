#include "tests/evaluation/wall.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "common/cpu_clock.h"
#include "common/error.h"
#include "common/image_io.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/start_clock.h"
#include "tests/loopback/process.h"

namespace framelet::bench {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto patience = 60s; ///< for a client that has been told to end: it still writes its last pictures

/// A display frame as the client tells of it (client/frame_log.h).
struct ShownFrame {
    std::uint64_t number = 0;
    double seconds = 0; ///< Unix
    double cpu_seconds = 0;
    double bytes = 0;
    bool changed = false;
    bool complete = false;
};

double unix_seconds() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

double cpu_seconds_of_process(pid_t pid) {
    clockid_t clock{};
    return clock_getcpuclockid(pid, &clock) == 0 ? cpu_seconds_of(clock) : 0;
}

/// What has been written so far; a last line that is not whole yet is left out.
std::vector<ShownFrame> read_frames(std::filesystem::path const& file) {
    std::vector<ShownFrame> frames;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line) && !stream.eof();) {
        json const entry = json::parse(line);
        frames.push_back({entry["frame"], entry["unix_seconds"], entry["cpu_seconds"], entry["bytes"], entry["changed"],
                          entry["complete"]});
    }
    return frames;
}

std::uint16_t port_of(std::string const& address) {
    return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
}

std::vector<std::string> server_options(BenchScene const& scene, WallOptions const& options) {
    char stops[40];
    std::snprintf(stops, sizeof(stops), "%.9g", std::log2(static_cast<double>(scene.exposure)));
    return {"--paused", "--exposure", stops, "--threads", std::to_string(options.server_threads)};
}

/// Display frames in files: quickly written, so that writing does not take the processors from what is measured.
std::vector<std::string> client_arguments(BenchScene const& scene, Viewport viewport, std::uint16_t port,
                                          WallOptions const& options, test::TemporaryFolder const& folder) {
    std::vector<std::string> arguments{"127.0.0.1:" + std::to_string(port),
                                       "--size",
                                       std::to_string(viewport.width) + "x" + std::to_string(viewport.height),
                                       "--duration",
                                       "100000", // until it is told to end
                                       "--rate",
                                       std::to_string(options.display_rate),
                                       "--output",
                                       (folder.path() / "%06d.ppm").string(),
                                       "--frames",
                                       (folder.path() / "frames.jsonl").string()};
    if (scene.scene_camera != none) {
        arguments.insert(arguments.end(),
                         {"--camera", folder.write("camera.json", json{{"scene_camera", scene.scene_camera}}.dump())});
    }
    return arguments;
}

/// What the measured time has seen.
struct WallRun {
    double start = 0; ///< at which the scene's time was 0, Unix seconds
    double server_cpu = 0;
    std::vector<ShownFrame> frames;
};

class WallSession {
public:
    WallSession(BenchScene const& scene, RunParameters const& run, WallOptions const& options)
        : options_(options), server_(scene.file.string(), server_options(scene, options)),
          link_(port_of(server_.address()), run.link),
          client_(FRAMELET_CLIENT, client_arguments(scene, run.viewport, link_.port(), options, folder_)) {}

    WallRun watch(double seconds, double delay) {
        wait_for_still_picture();
        WallRun run;
        double const server_before = cpu_seconds_of_process(server_.process().pid());
        run.start = start_scene_clock(port_of(server_.address()));
        sleep_until(run.start + seconds);
        run.server_cpu = cpu_seconds_of_process(server_.process().pid()) - server_before;
        sleep_until(run.start + seconds + delay); // what is on its way
        client_.signal(SIGTERM);
        if (int const code = client_.wait(patience); code != 0) {
            throw ConnectionError("framelet-client ended with " + std::to_string(code) + ": " + client_.errors());
        }
        run.frames = read_frames(folder_.path() / "frames.jsonl");
        return run;
    }

    Picture picture(ShownFrame const& frame) const {
        char name[40];
        std::snprintf(name, sizeof(name), "%06llu.ppm", static_cast<unsigned long long>(frame.number));
        return read_picture(folder_.path() / name);
    }

private:
    void wait_for_still_picture() {
        double const latest = unix_seconds() + options_.most_lead_seconds;
        while (unix_seconds() < latest) {
            auto const frames = read_frames(folder_.path() / "frames.jsonl");
            if (!frames.empty() && frames.back().complete) {
                return;
            }
            if (!client_.running()) {
                throw ConnectionError("framelet-client ended early: " + client_.errors());
            }
            std::this_thread::sleep_for(50ms);
        }
    }

    static void sleep_until(double seconds) {
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds - unix_seconds()));
    }

    WallOptions const options_;
    test::TemporaryFolder folder_;
    test::ServerProcess server_;
    LinkEmulator link_;
    test::Process client_;
};

/// The newest frame at that time.
ShownFrame const& frame_at(std::vector<ShownFrame> const& frames, double seconds) {
    auto const next = std::ranges::upper_bound(frames, seconds, {}, &ShownFrame::seconds);
    return next == frames.begin() ? frames.front() : *std::prev(next);
}

MethodRecord record_of(WallSession const& session, WallRun const& run, Reference const& reference,
                       RunParameters const& parameters) {
    std::size_t const times = reference_count(parameters);
    MethodRecord record;
    record.method = "wall";
    record.measures.resize(times);
    tbb::parallel_for(std::size_t(0), times, [&](std::size_t i) {
        ShownFrame const& frame = frame_at(run.frames, run.start + reference_time(parameters, i));
        record.measures[i] = measure(session.picture(frame), reference.picture(i));
    });
    ShownFrame const& first = frame_at(run.frames, run.start);
    ShownFrame const& last = frame_at(run.frames, run.start + parameters.seconds);
    record.run.cpu.render = run.server_cpu; // all of the server; the process does not tell its stages apart
    record.run.cpu.reconstruct = last.cpu_seconds - first.cpu_seconds;
    record.run.bytes = static_cast<std::uint64_t>(last.bytes - first.bytes);
    for (ShownFrame const& frame : run.frames) {
        double const shown = frame.seconds - run.start;
        if (frame.changed && shown >= 0 && shown < parameters.seconds) {
            record.run.displayed.push_back(shown);
        }
    }
    return record;
}

/// The machine that has so many threads as fast as the calibrated one.
MethodRecord predict(BenchScene& scene, Reference const& reference, StudyOptions const& study, int threads) {
    RunParameters parameters = study.run;
    parameters.frames_per_second = 1;
    double const machine = 1.0 / threads;
    parameters.frames_per_second = machine_factor(scene, parameters, study.costs) / machine;
    MethodRecord record = record_method(scene, reference, "framelet", parameters, machine, study.costs);
    record.method = "virtual";
    // The virtual clock ends with the step under way; what shows later is not seen here.
    std::erase_if(record.run.displayed, [&](double seconds) { return seconds >= parameters.seconds; });
    return record;
}

json figures_of(MethodRecord const& record) {
    json mse = json::array();
    double sum_ssim = 0, sum_psnr = 0, sum_flip = 0;
    for (Measures const& measures : record.measures) {
        mse.push_back(measures.mse);
        sum_psnr += measures.psnr;
        sum_ssim += measures.ssim;
        sum_flip += measures.flip;
    }
    double const count = static_cast<double>(record.measures.size());
    return {{"mean",
             {{"mse", mean_mse(record)},
              {"psnr", sum_psnr / count},
              {"ssim", sum_ssim / count},
              {"flip", sum_flip / count}}},
            {"cpu_seconds", {{"server", record.run.cpu.server()}, {"viewer", record.run.cpu.viewer()}}},
            {"bytes", record.run.bytes},
            {"displayed", record.run.displayed},
            {"mse", mse}};
}

void print(char const* name, json const& figures, double seconds) {
    json const& mean = figures["mean"];
    std::printf("%-14s %10.3e %6.2f %6.4f %6.4f %8zu %8.3f %8.3f %9.1f\n", name, mean["mse"].get<double>(),
                mean["psnr"].get<double>(), mean["ssim"].get<double>(), mean["flip"].get<double>(),
                figures["displayed"].size(), figures["cpu_seconds"]["server"].get<double>(),
                figures["cpu_seconds"]["viewer"].get<double>(), figures["bytes"].get<double>() / seconds / 1e3);
}

} // namespace

json measure_wall(BenchScene& scene, StudyOptions const& study, WallOptions const& options) {
    RunParameters const& run = study.run;
    Reference const reference = reference_of(scene, study);
    MethodRecord const measured = [&] {
        WallSession session(scene, run, options);
        WallRun const seen = session.watch(run.seconds, 0.2 + 2 * (run.link.delay_seconds + run.link.jitter_seconds));
        return record_of(session, seen, reference, run);
    }();
    MethodRecord const predicted = predict(scene, reference, study, options.server_threads);

    json const result{{"scene", scene.name},
                      {"viewport", {run.viewport.width, run.viewport.height}},
                      {"seconds", run.seconds},
                      {"reference_rate", run.reference_rate},
                      {"server_threads", options.server_threads},
                      {"link",
                       {{"bits_per_second", run.link.bits_per_second},
                        {"delay_seconds", run.link.delay_seconds},
                        {"jitter_seconds", run.link.jitter_seconds}}},
                      {"wall", figures_of(measured)},
                      {"virtual", figures_of(predicted)}};
    std::printf("%s, %dx%d, %g s, server on %d threads, link %.3g Mbit/s, %.0f ms each way\n", scene.name.c_str(),
                run.viewport.width, run.viewport.height, run.seconds, options.server_threads,
                run.link.bits_per_second / 1e6, 1e3 * run.link.delay_seconds);
    std::printf("%-14s %10s %6s %6s %6s %8s %8s %8s %9s\n", "clock", "mse", "psnr", "ssim", "flip", "pictures",
                "server s", "viewer s", "kB/s");
    print("wall", result["wall"], run.seconds);
    print("virtual", result["virtual"], run.seconds);
    if (!study.charts.empty()) {
        ErrorOverTime chart{.title = scene.name + ": error over time, real processes and virtual clock", .series = {}};
        for (MethodRecord const* const record : {&measured, &predicted}) {
            chart.series.push_back(error_series(*record, run));
        }
        std::filesystem::create_directories(study.charts);
        draw(chart, study.charts / (scene.name + "-wall"));
    }
    return result;
}

} // namespace framelet::bench
