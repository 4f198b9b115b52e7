#include "tests/evaluation/report/report_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "tests/evaluation/comparison.h"
#include "tests/evaluation/own_camera.h"
#include "tests/evaluation/report/feature_cost.h"
#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/report/run_store.h"
#include "tests/evaluation/scene_events.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// Number of moments at which both clocks are compared: with few of them what is seen of a cut or a lamp would decide.
constexpr int clock_moments = 16;

/// First line that a command prints, without its end; empty where it fails.
std::string output_of(std::string const& command) {
    std::unique_ptr<FILE, int (*)(FILE*)> const pipe(popen(command.c_str(), "r"), pclose);
    std::array<char, 256> line{};
    if (!pipe || std::fgets(line.data(), line.size(), pipe.get()) == nullptr) {
        return "";
    }
    std::string text = line.data();
    text.erase(text.find_last_not_of('\n') + 1);
    return text;
}

std::string commit_of_source() {
    std::string const commit = output_of("git -C '" FRAMELET_SOURCE_DIR "' describe --always --dirty 2>/dev/null");
    return commit.empty() ? "unknown" : commit;
}

std::string text_of(Viewport const& size) {
    return printed("%dx%d", size.width, size.height);
}

/// Makes a scene's runs. Loads the scene for the first run that is not stored yet.
class SceneRuns {
public:
    SceneRuns(std::filesystem::path file, StudyOptions const& study, RunStore& store)
        : file_(std::move(file)), study_(study), store_(store) {}

    ReportRun run(std::string const& method, double machine, double link, double delay) {
        RunParameters const& p = study_.run;
        std::string const turn = study_.turn > 0 ? printed("-t%g", study_.turn) : "";
        std::string const name = scene() + "-" + method + "-" + text_of(p.viewport) +
                                 printed("-%gs-%ghz-m%g-l%g", p.seconds, p.reference_rate, machine, link) + turn;
        json const figures = store_.get(name, [&] { return measure_run(method, machine, link, delay); });
        ReportRun result{scene() + turn, method, machine, link, noise(), 0, 0, 0, 0, {}};
        result.mse = figures["mean"]["mse"];
        result.flip = figures["mean"]["flip"];
        result.unsteadiness = figures["mean"]["unsteadiness"];
        result.bits = 8 * figures["bytes"].get<double>() / (pixels() * p.seconds);
        result.phases = means_by_phase(figures["mse"]);
        return result;
    }

private:
    std::string scene() const { return file_.stem().string(); }
    double pixels() const { return static_cast<double>(study_.run.viewport.width) * study_.run.viewport.height; }

    Subject& subject() {
        if (!subject_) {
            StudyOptions whole = study_;
            whole.sees_events = true;
            whole.run.frames_per_second = 1;
            subject_.emplace(prepare(file_, whole));
        }
        return *subject_;
    }

    /// Noise of the reference: its mean squared error against one of 256 samples a pixel, which has next to none.
    double noise() {
        RunParameters const& p = study_.run;
        std::string const name = scene() + "-noise-" + text_of(p.viewport) + printed("-%gs", p.seconds);
        return store_.get(name, [&] {
            Subject& s = subject();
            std::size_t const middle = reference_count(s.run) / 2;
            pose_at(*s.scene, s.run.start + reference_time(s.run, middle));
            Picture const clean = render_reference(*s.scene, s.run.viewport, 16);
            return json(mean_squared_error(s.reference.picture(middle), clean));
        });
    }

    json measure_run(std::string const& method, double machine, double link, double delay) {
        Subject& s = subject();
        RunParameters run = s.run;
        run.frames_per_second = machine;
        run.link.bits_per_second = link * pixels();
        run.link.delay_seconds = delay;
        Comparison comparison;
        comparison.parameters = run;
        comparison.records.push_back(
            record_method(*s.scene, s.reference, method, run, s.machine / machine, study_.costs));
        json figures = to_json(comparison)["methods"][0];
        for (char const* const list : {"ssim", "flip", "age", "displayed"}) {
            figures.erase(list);
        }
        return figures;
    }

    std::map<std::string, double> means_by_phase(std::vector<double> const& errors) {
        if (!events_) {
            events_ = events_of(scene());
            start_ = window_start(scene(), study_.run.seconds);
        }
        std::map<std::string, std::pair<double, double>> sums;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            Phase const phase = phase_at(*events_, start_ + reference_time(study_.run, i));
            auto& [sum, count] = sums[phase == Phase::moving ? "moving" : phase == Phase::event ? "event" : "settled"];
            sum += errors[i];
            ++count;
        }
        std::map<std::string, double> means;
        for (auto const& [phase, sum] : sums) {
            means[phase] = sum.first / sum.second;
        }
        return means;
    }

    std::filesystem::path const file_;
    StudyOptions const& study_;
    RunStore& store_;
    std::optional<Subject> subject_;
    std::optional<SceneEvents> events_; ///< the scene's events, found with the first run
    double start_ = 0; ///< start of the scene's window, likewise
};

json live_run(std::filesystem::path const& file, LiveOptions const& options, RunStore& store) {
    std::string const name = file.stem().string() +
                             (options.predicts ? "-clocks-"
                              : options.pinned ? "-pinned-"
                                               : "-live-") +
                             text_of(options.viewport) + printed("-%gs-%d", options.seconds, options.moments) +
                             (options.camera_file.empty() ? "" : "-flown") +
                             (options.link.bits_per_second > 0 ? "-narrow" : "");
    return store.get(name, [&] {
        auto const scene = load_bench_scene(file);
        scene->name += options.camera_file.empty() ? "" : ", flown";
        scene->name += options.link.bits_per_second > 0 ? ", narrow link" : "";
        return measure_live(*scene, options);
    });
}

/// Makes the runs with a turning camera, without a link's limit.
void measure_turns(ReportOptions const& options, StudyOptions study, RunStore& store, std::vector<ReportRun>& runs) {
    for (double const turn : options.turns) {
        study.turn = turn;
        for (auto const& file : study.scenes) {
            SceneRuns scene(file, study, store);
            for (char const* const method : {"framed+h264", "framed+warp", "framelet"}) {
                runs.push_back(scene.run(method, usual_machine(options), 0, 0));
            }
        }
    }
}

} // namespace

double usual_machine(ReportOptions const& options) {
    double const usual = 2 * core_rate / screen_pixels;
    return *std::ranges::min_element(options.machines, {},
                                     [&](double machine) { return std::abs(std::log(machine / usual)); });
}

ReportFigures measure_report(ReportOptions const& options, StudyOptions const& study) {
    ReportFigures figures;
    figures.commit = commit_of_source();
    std::size_t const runs_a_scene =
        1 + options.machines.size() * study.methods.size() + options.links.size() * options.linked_methods.size();
    // The noise is asked for with each run, so that runs count twice.
    std::size_t const expected = study.scenes.size() * (2 * runs_a_scene - 2 + 4 + 6 * options.turns.size()) +
                                 options.live_scenes.size() + options.flights.size() + options.narrow_scenes.size() +
                                 options.walks.size() + 2 * options.clock_scenes.size() * options.clock_sizes.size() +
                                 1;
    RunStore store(options.folder, figures.commit, expected);
    for (auto const& file : study.scenes) {
        SceneRuns scene(file, study, store);
        for (double const machine : options.machines) {
            for (std::string const& method : study.methods) {
                figures.runs.push_back(scene.run(method, machine, 0, 0));
            }
        }
        for (double const link : options.links) {
            for (std::string const& method : options.linked_methods) {
                figures.runs.push_back(scene.run(method, options.link_machine, link, options.link_delay));
            }
        }
    }
    measure_turns(options, study, store, figures.turns);
    for (Flight const& walk : options.walks) {
        OwnCameraOptions own;
        own.viewport = options.walk_viewport;
        own.jumps = options.quick ? 4 : own.jumps;
        own.costs = study.costs;
        figures.walks.push_back(store.get(walk.scene.stem().string() + "-walk-" + text_of(own.viewport),
                                          [&] { return measure_own_camera(walk.scene, walk.camera, own); }));
    }
    for (auto const& file : options.live_scenes) {
        figures.live.push_back(live_run(file, options.live, store));
    }
    for (Flight const& flight : options.flights) {
        LiveOptions live = options.live;
        live.camera_file = flight.camera;
        figures.live.push_back(live_run(flight.scene, live, store));
    }
    for (auto const& file : options.narrow_scenes) {
        LiveOptions live = options.live;
        live.methods = {"framelet", "framed+h264", "framed+warp"};
        live.link = options.narrow;
        figures.narrow.push_back(live_run(file, live, store));
    }
    for (Viewport const size : options.clock_sizes) {
        for (auto const& file : options.clock_scenes) {
            LiveOptions live = options.live;
            live.viewport = size;
            live.methods = {"framelet"};
            live.moments = options.quick ? 2 : clock_moments;
            live.pinned = live.predicts = true;
            live.costs = study.costs;
            json run = live_run(file, live, store);
            live.methods = {"framelet-unwarped"}; // run only for how busy it keeps the server
            live.moments = 1;
            live.predicts = false;
            run["methods"].update(live_run(file, live, store)["methods"]);
            figures.clocks.push_back(std::move(run));
        }
    }
    figures.features = store.get("features-" + text_of(options.feature_viewport), [&] {
        return measure_feature_costs(FRAMELET_SOURCE_DIR "/scenes/stop.glb", options.feature_viewport,
                                     options.quick ? 0.3 : 2, study.costs);
    });
    figures.commits = store.commits();
    return figures;
}

} // namespace framelet::bench
