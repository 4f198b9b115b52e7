#include "tests/evaluation/live/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <sched.h>
#include <span>
#include <thread>

#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include "client/core/camera/camera_path.h"
#include "client/frames/frame_choice.h"
#include "common/error.h"
#include "common/files/image_io.h"
#include "server/render/framelet_renderer.h"
#include "server/render/path/path_picture.h"
#include "tests/evaluation/charts/picture_sheet.h"
#include "tests/evaluation/codecs/link_emulator.h"
#include "tests/evaluation/figure_table.h"
#include "tests/evaluation/live/live_frames.h"
#include "tests/evaluation/live/prediction.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/rival_choice.h"
#include "tests/loopback/process.h"

namespace framelet::bench {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto patience = 120s; ///< time for a client to write its last pictures

/// Command lines: the real programs for the project's own methods, this program for the others, since it serves and
/// shows any method.
struct Programs {
    std::string server, client;
    std::vector<std::string> server_words, client_words; ///< words that come first
    std::vector<std::string> client_more;
};

std::vector<std::string> joined(std::vector<std::string> words, std::vector<std::string> const& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The programs for a method. Through an emulated link the client connects to another port, for which it finds no
/// token: the server lets everybody in. The scene's clock stands until the viewer has come and lets it run, however
/// long a viewer takes to start: all have built up equally long when pictures are compared.
Programs programs_of(std::string const& method, RivalParts const& rivals, std::string const& scene) {
    if (method == "framelet") {
        return {FRAMELET_SERVER,
                FRAMELET_CLIENT,
                {scene, "--port", "0", "--insecure", "--paused"},
                {},
                {"--json", "--play"}};
    }
    if (method == "framelet-unwarped") {
        return {FRAMELET_SERVER,
                FRAMELET_CLIENT,
                {scene, "--port", "0", "--insecure", "--paused"},
                {},
                {"--json", "--play", "--no-reprojection"}};
    }
    std::string const self = std::filesystem::read_symlink("/proc/self/exe").string();
    std::vector<std::string> const parts{"--spacing", std::to_string(rivals.spacing), "--margin",
                                         std::to_string(rivals.margin)};
    return {self, self, joined({"serve", method, scene}, parts), {"look", method, scene}, parts};
}

/// Keeps the programs that this thread starts meanwhile on one core; from their beginning on they know of no other.
class OnCore {
public:
    explicit OnCore(std::optional<std::size_t> core) {
        sched_getaffinity(0, sizeof before_, &before_);
        if (core) {
            cpu_set_t one;
            CPU_ZERO(&one);
            CPU_SET(*core, &one);
            sched_setaffinity(0, sizeof one, &one);
        }
    }
    ~OnCore() { sched_setaffinity(0, sizeof before_, &before_); }
    OnCore(OnCore const&) = delete;
    OnCore& operator=(OnCore const&) = delete;

private:
    cpu_set_t before_{};
};

std::optional<std::size_t> core_if(bool pinned, std::size_t core) {
    return pinned ? std::optional(core) : std::nullopt;
}

/// Results of one run, its pictures included.
struct LiveRun {
    test::TemporaryFolder folder;
    std::vector<LiveFrame> frames;
    double server_cores = 0; ///< cores that the server used while both were at work
    double server_seconds = 0; ///< processor seconds that the server used since the viewer came, until `watched_until`
    double watched_until = 0; ///< end of the watch, Unix seconds
    json statistics; ///< statistics as the client prints them; discarded value where another program looks

    std::filesystem::path picture_file(std::uint64_t frame) const {
        char name[40];
        std::snprintf(name, sizeof name, "%06llu.ppm", static_cast<unsigned long long>(frame));
        return folder.path() / name;
    }
    Picture picture(std::size_t frame) const { return read_picture(picture_file(frames[frame].number)); }
    /// Indices of the frames that left a picture.
    std::vector<std::size_t> written_frames() const {
        std::vector<std::size_t> written;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (std::filesystem::exists(picture_file(frames[i].number))) {
                written.push_back(i);
            }
        }
        return written;
    }
};

void run_programs(BenchScene const& scene, std::string const& method, RivalParts const& rivals,
                  LiveOptions const& options, LiveRun& run) {
    Programs const programs = programs_of(method, rivals, scene.file.string());
    char stops[40];
    std::snprintf(stops, sizeof stops, "%.9g", std::log2(static_cast<double>(scene.exposure)));
    std::vector<std::string> server_options{"--exposure", stops,        "--threads", options.pinned ? "1" : "0",
                                            "--light",    options.light};
    auto server = [&] {
        OnCore const core(core_if(options.pinned, 0));
        return test::ServerProcess::of_program(programs.server, joined(programs.server_words, server_options));
    }();
    std::string const& address = server.address();
    auto const port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    std::optional<LinkEmulator> link;
    if (options.link.bits_per_second > 0 || options.link.delay_seconds > 0) {
        link.emplace(port, options.link);
    }
    std::string const size = std::to_string(options.viewport.width) + "x" + std::to_string(options.viewport.height);
    std::vector<std::string> client_options{"127.0.0.1:" + std::to_string(link ? link->port() : port),
                                            "--size",
                                            size,
                                            "--duration",
                                            std::to_string(options.seconds),
                                            "--rate",
                                            "60",
                                            "--output",
                                            (run.folder.path() / "%06d.ppm").string(),
                                            "--frames",
                                            (run.folder.path() / "frames.jsonl").string()};
    std::vector<std::string> times{"--output-times"};
    for (int k = 0; k < options.moments; ++k) {
        double const window = options.seconds - build_up_seconds;
        times.push_back(std::to_string(build_up_seconds + (k + 0.5) / options.moments * window));
    }
    client_options = joined(client_options, times);
    if (!options.camera_file.empty()) {
        client_options = joined(client_options, {"--camera", options.camera_file.string()});
    } else if (scene.scene_camera != none) {
        client_options =
            joined(client_options,
                   {"--camera", run.folder.write("camera.json", json{{"scene_camera", scene.scene_camera}}.dump())});
    }
    double const idle = cpu_of(server.process().pid());
    auto client = [&] {
        OnCore const core(core_if(options.pinned, 1));
        return test::Process(programs.client,
                             joined(joined(programs.client_words, client_options), programs.client_more));
    }();
    // The watch leaves out the client's beginning and end, when the server has little to do.
    std::this_thread::sleep_for(std::chrono::duration<double>(build_up_seconds));
    double const before = cpu_of(server.process().pid());
    auto const begun = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds - build_up_seconds - 0.2));
    std::chrono::duration<double> const watched = std::chrono::steady_clock::now() - begun;
    double const after = cpu_of(server.process().pid());
    run.watched_until = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    run.server_cores = (after - before) / watched.count();
    run.server_seconds = after - idle;
    if (int const code = client.wait(patience); code != 0) {
        throw ConnectionError(method + ": the viewer ended with " + std::to_string(code) + ": " + client.errors());
    }
    run.statistics = json::parse(client.output(), nullptr, false);
    run.frames = read_frames(run.folder.path() / "frames.jsonl");
    if (run.frames.size() < 10) {
        throw ConnectionError(method + ": the viewer showed " + std::to_string(run.frames.size()) + " pictures");
    }
}

Picture reference_of(BenchScene& scene, LiveFrame const& frame, LiveOptions const& options) {
    pose_at(scene, frame.scene_time);
    Camera const camera =
        frame.scene_camera >= 0 ? scene.posed->camera(frame.scene_camera, frame.scene_time) : frame.camera;
    if (PathLight const* const light = scene.posed->path_light()) {
        PathOptions paths = light->options();
        paths.paths = options.paths;
        return to_display(render_paths(*scene.render_scene, camera, options.viewport, paths), scene.exposure);
    }
    return render_picture(*scene.render_scene, camera, options.viewport, scene.exposure, options.samples_per_side);
}

/// Rates and costs of the run; does not look at pictures.
json run_figures(LiveRun const& run) {
    std::vector<double> gaps, photons;
    double changed = 0;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        LiveFrame const& frame = run.frames[i];
        changed += frame.changed ? 1 : 0;
        if (i > 0) {
            gaps.push_back(frame.seconds - run.frames[i - 1].seconds);
        }
        if (frame.photon_seconds >= 0) {
            photons.push_back(frame.photon_seconds);
        }
    }
    LiveFrame const& last = run.frames.back();
    auto steady = std::ranges::find_if(run.frames, [&run](LiveFrame const& frame) {
        return frame.seconds >= run.frames.front().seconds + build_up_seconds;
    });
    if (steady == run.frames.end()) { // the run ended early
        steady = run.frames.begin();
    }
    double const steady_span = last.seconds - steady->seconds;
    auto const steady_pictures =
        std::count_if(steady + 1, run.frames.end(), [](auto const& frame) { return frame.changed; });
    double const span = last.seconds - run.frames.front().seconds;
    auto watched =
        std::ranges::find_if(run.frames, [&run](LiveFrame const& frame) { return frame.seconds >= run.watched_until; });
    watched = watched == run.frames.end() ? watched - 1 : watched;
    /// Offset of the steady clock from the system's, which is the same for all processes.
    double const clock_offset = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch() -
                                                              std::chrono::system_clock::now().time_since_epoch())
                                    .count();
    double const cores = std::max(1u, std::thread::hardware_concurrency());
    double const viewer = (last.cpu_seconds - run.frames.front().cpu_seconds) / span;
    return {{"pictures_per_second", changed / span},
            {"gap_p99_ms", 1e3 * percentile(gaps, 0.99)},
            {"server_cores", run.server_cores},
            {"viewer_cores", viewer},
            {"server_busy", run.server_cores / cores},
            {"viewer_busy", viewer / cores},
            {"samples_per_second", last.samples / span},
            {"kB_per_second", last.bytes / span / 1e3},
            {"start_seconds", run.frames.front().scene_time},
            {"server_seconds_per_sample", run.server_seconds / std::max(watched->samples, 1.0)},
            {"start_clock", run.frames.front().seconds + clock_offset},
            {"steady",
             {{"pictures_per_second", static_cast<double>(steady_pictures) / steady_span},
              {"kB_per_second", (last.bytes - steady->bytes) / steady_span / 1e3},
              {"samples_per_second", (last.samples - steady->samples) / steady_span},
              {"server_cores", run.server_cores},
              {"viewer_cores", (last.cpu_seconds - steady->cpu_seconds) / steady_span}}},
            {"paint_ns_per_pixel", run.statistics.is_object() ? run.statistics["reconstruct_ns_per_pixel"] : json()},
            {"photon_ms", photons.empty() ? json() : json(1e3 * percentile(photons, 0.5))}};
}

/// Figures of one run, and the moments at which its pictures were compared.
struct Measured {
    json figures;
    std::vector<ComparedMoment> moments;
};

constexpr std::size_t shown_between = FrameChoice::frames_at_once / 2;
constexpr std::size_t trial_moments = 2;

/// Index, within the row of frames from `first` on, of the one that was shown closest to the moment for which it was
/// made. On the virtual clock every compared frame is punctual; in a real session a millisecond of the operating
/// system's decides where a car passes by.
std::size_t most_punctual(std::vector<LiveFrame> const& frames, std::size_t first) {
    auto const row = std::span(frames).subspan(first, FrameChoice::frames_at_once);
    auto const off = [](LiveFrame const& frame) { return std::max(frame.photon_seconds, 0.0); };
    return static_cast<std::size_t>(std::ranges::min_element(row, {}, off) - row.begin());
}

/// True if unsteadiness is measured at this moment. It takes three references a moment, so that it is measured at every
/// other one and, where the virtual clock is compared with the run, at none.
bool looks_at_steadiness(LiveOptions const& options, std::size_t moment) {
    return options.steadiness && !options.predicts && moment % 2 == 0;
}

/// Measures errors at some moments, spread over the run.
Measured error_figures(BenchScene& scene, std::string const& method, LiveRun const& run, LiveOptions const& options) {
    std::vector<std::size_t> const written = run.written_frames();
    json figures{{"mse", 0.0}, {"ssim", 0.0}, {"flip", 0.0}, {"steadiness", 0.0}};
    std::vector<ComparedMoment> moments;
    std::size_t const count = written.size() / FrameChoice::frames_at_once;
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t const first = written[k * FrameChoice::frames_at_once];
        std::size_t const chosen = options.predicts ? most_punctual(run.frames, first) : shown_between;
        std::array<Picture, FrameChoice::frames_at_once> shown, reference;
        for (std::size_t i = 0; i < shown.size(); ++i) {
            if (i == chosen || looks_at_steadiness(options, k)) {
                shown[i] = run.picture(first + i);
                reference[i] = reference_of(scene, run.frames[first + i], options);
            }
        }
        Measures const measures = measure(shown[chosen], reference[chosen]);
        auto const add = [&](char const* name, double value, std::size_t of) {
            figures[name] = figures[name].get<double>() + value / static_cast<double>(of);
        };
        add("mse", measures.mse, count);
        add("ssim", measures.ssim, count);
        add("flip", measures.flip, count);
        if (looks_at_steadiness(options, k)) {
            add("steadiness", unsteadiness(shown, reference), (count + 1) / 2);
        }
        figures["moment_mse"].push_back(measures.mse);
        if (!options.charts.empty()) {
            write_beside_reference(options.charts / (scene.name + "-" + method + "-" + std::to_string(k) + ".png"),
                                   reference[chosen], std::span(shown).subspan(chosen, 1));
        }
        moments.push_back({run.frames[first + chosen].scene_time, std::move(reference[chosen])});
    }
    figures["psnr"] = psnr_from_mse(figures["mse"]);
    return {std::move(figures), std::move(moments)};
}

/// Rough mean squared error at a few of the moments: enough to tell a rival's choices apart.
double trial_error(BenchScene& scene, LiveRun const& run, LiveOptions options) {
    options.samples_per_side = std::min(options.samples_per_side, 2);
    options.paths = std::min(options.paths, 16);
    std::vector<std::size_t> const written = run.written_frames();
    std::size_t const count = written.size() / FrameChoice::frames_at_once;
    std::size_t const looks = std::min(count, trial_moments);
    double sum = 0;
    for (std::size_t k = 0; k < looks; ++k) {
        std::size_t const moment = (2 * k + 1) * count / (2 * looks); // the middle of each part of the run
        std::size_t const frame = written[moment * FrameChoice::frames_at_once] + shown_between;
        sum += mean_squared_error(run.picture(frame), reference_of(scene, run.frames[frame], options));
    }
    return sum / static_cast<double>(looks);
}

Measured measure_run(BenchScene& scene, std::string const& method, LiveRun const& run, LiveOptions const& options) {
    Measured measured = error_figures(scene, method, run, options);
    measured.figures.update(run_figures(run));
    return measured;
}

double psnr_of(Measured const& measured) {
    return measured.figures["psnr"];
}

/// Runs all choices that a rival has, each by itself, the one that errs least as often as is asked, and measures that.
Measured best_run(BenchScene& scene, std::string const& method, LiveOptions const& options) {
    std::vector<RivalParts> const choices = rival_choices(method, {});
    std::vector<std::unique_ptr<LiveRun>> trials;
    std::vector<double> errors;
    for (RivalParts const& choice : choices) {
        LiveRun& run = *trials.emplace_back(std::make_unique<LiveRun>());
        run_programs(scene, method, choice, options, run);
        errors.push_back(choices.size() > 1 ? trial_error(scene, run, options) : 0);
    }
    std::size_t const best = best_choice(errors);
    std::vector<Measured> runs;
    runs.push_back(measure_run(scene, method, *trials[best], options));
    while (std::ssize(runs) < options.runs) {
        LiveRun run;
        run_programs(scene, method, choices[best], options, run);
        runs.push_back(measure_run(scene, method, run, options));
    }
    std::ranges::sort(runs, {}, psnr_of);
    Measured& measured = runs[runs.size() / 2];
    json& figures = measured.figures;
    figures["psnr_low"] = psnr_of(runs.front());
    figures["psnr_high"] = psnr_of(runs.back());
    if (has_spacing(method)) {
        figures["spacing"] = choices[best].spacing;
        figures["margin"] = choices[best].margin;
    }
    return std::move(measured);
}

/// Title of a method's row: the method, with the spacing that its frames had and an m for a margin.
std::string row_title(std::string const& method, json const& figures) {
    return figures.contains("spacing")
               ? method + " (" + std::to_string(figures["spacing"].get<int>()) + (figures["margin"] > 0 ? "+m)" : ")")
               : method;
}

/// Prints the rates of both clocks, once nothing is built up any more.
void print_prediction(json const& figures) {
    auto const line = [&figures](char const* name, json const& rates, json const& of) {
        std::printf(
            "  %-16s %6.1f pictures/s  %7.0f kB/s  %6.2f dB  %5.2f Msamples/s  server %.2f  viewer %.2f cores\n", name,
            rates["pictures_per_second"].get<double>(), rates["kB_per_second"].get<double>(), of["psnr"].get<double>(),
            rates["samples_per_second"].get<double>() / 1e6, rates["server_cores"].get<double>(),
            rates["viewer_cores"].get<double>());
    };
    line("wall clock", figures["steady"], figures);
    line("virtual clock", figures["virtual"], figures["virtual"]);
    std::fflush(stdout);
}

} // namespace

std::unique_ptr<BenchScene> load_live_scene(std::filesystem::path const& file, std::string const& light) {
    bool const is_direct = parse_light_method(light) == LightMethod::direct;
    return load_bench_scene(file, Clips::usual, {}, is_direct ? LightMethod::direct : LightMethod::reference);
}

json measure_live(BenchScene& scene, LiveOptions const& options) {
    std::printf("%s, %dx%d, %g s%s\n", scene.name.c_str(), options.viewport.width, options.viewport.height,
                options.seconds, options.pinned ? ", a core each" : "");
    FigureTable const table({{"method", "/title", -18},
                             {"pict/s", "/pictures_per_second", 6, 1},
                             {"gap ms", "/gap_p99_ms", 6, 0},
                             {"server", "/server_busy", 6},
                             {"viewer", "/viewer_busy", 6},
                             {"Msam/s", "/samples_per_second", 7, 2, 1e-6},
                             {"kB/s", "/kB_per_second", 7, 0},
                             {"photon", "/photon_ms", 7, 0},
                             {"PSNR", "/psnr", 6},
                             {"SSIM", "/ssim", 6, 4},
                             {"FLIP", "/flip", 6, 4},
                             {"unsteady", "/steadiness", 9, 2, 1, true}});
    json methods;
    for (std::string const& method : options.methods) {
        Measured const measured = best_run(scene, method, options);
        json& figures = methods[method] = measured.figures;
        json row = figures;
        row["title"] = row_title(method, figures);
        table.print(row);
        if (options.predicts && (method == "framelet" || method == "framelet-unwarped")) {
            figures["virtual"] = predict_live(scene, method, options, measured.figures, measured.moments);
            print_prediction(figures);
        }
    }
    return {
        {"scene", scene.name},
        {"size", {options.viewport.width, options.viewport.height}},
        {"seconds", options.seconds},
        {"link", {{"bits_per_second", options.link.bits_per_second}, {"delay_seconds", options.link.delay_seconds}}},
        {"methods", methods}};
}

} // namespace framelet::bench
