#include "tests/evaluation/report/report_runs.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "common/error.h"
#include "tests/evaluation/comparison.h"
#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/report/run_store.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// What a command prints; empty where it fails.
std::string output_of(std::string const& command) {
    std::unique_ptr<FILE, int (*)(FILE*)> const pipe(popen((command + " 2>/dev/null").c_str(), "r"), pclose);
    std::string text;
    for (int c = 0; pipe && (c = std::fgetc(pipe.get())) != EOF;) {
        text += static_cast<char>(c);
    }
    return text;
}

/// The commit of the source, without what the report itself writes. Throws InputError where there is none, or more.
std::string commit_of_source(bool is_quick) {
    std::string const git = "git -C '" FRAMELET_SOURCE_DIR "' ";
    std::string commit = output_of(git + "rev-parse --short=8 HEAD");
    commit.erase(std::min(commit.find('\n'), commit.size()));
    if (is_quick) {
        return commit.empty() ? "unknown" : commit;
    }
    std::string const changed = output_of(git + "status --porcelain -- ':!docs/RESULTS.md' ':!docs/pictures'");
    if (commit.empty() || !changed.empty()) {
        throw InputError("what would be measured is of no commit" +
                         (changed.empty() ? ": there is no repository"
                                          : ", since this has changed: " + changed.substr(0, changed.find('\n'))));
    }
    return commit;
}

std::string text_of(Viewport const& size) {
    return printed("%dx%d", size.width, size.height);
}

/// Runs the real programs; `name` is the run's beside its scene.
json live_run(Flight const& flight, LiveOptions options, std::string const& name, RunStore& store) {
    options.camera_file = flight.camera;
    bool const is_flown = !flight.camera.empty();
    std::string const scene = flight.scene.stem().string() + (is_flown ? "-flown" : "");
    return store.get(scene + "-" + options.light + "-" + text_of(options.viewport) + name, [&] {
        auto const loaded = load_live_scene(flight.scene, options.light);
        loaded->name += is_flown ? ", flown" : "";
        return measure_live(*loaded, options);
    });
}

/// Runs the methods in one scene with each number of cores. Loads the scene where a run is not stored yet.
void run_with_cores(std::filesystem::path const& file, ReportOptions const& options, StudyOptions const& study,
                    RunStore& store, std::vector<CoreRun>& runs) {
    std::optional<Subject> subject;
    std::string const scene = file.stem().string();
    double const pixels = static_cast<double>(options.screen.width) * options.screen.height;
    for (int const cores : options.cores) {
        for (std::string const& method : study.methods) {
            std::string const name =
                scene + "-" + method + "-" + text_of(study.run.viewport) + printed("-%d-cores", cores);
            double const mse = store.get(name, [&] {
                if (!subject) {
                    StudyOptions whole = study;
                    whole.sees_events = true;
                    whole.run.frames_per_second = 1; // so that `machine` is what one sample a pixel and second takes
                    subject.emplace(prepare(file, whole));
                }
                RunParameters run = subject->run;
                run.frames_per_second = cores * core_rate / pixels;
                return json(mean_mse(record_method(*subject->scene, subject->reference, method, run,
                                                   subject->machine / run.frames_per_second, study.costs)));
            });
            runs.push_back({scene, method, cores, mse});
        }
    }
}

} // namespace

std::vector<LinkCase> link_cases(ReportOptions const& options) {
    std::vector<LinkCase> cases;
    for (double const rate : options.rates) {
        cases.push_back({rate, options.usual.round_trip});
    }
    for (double const round_trip : options.round_trips) {
        LinkCase const link{options.usual.megabits, round_trip};
        if (std::ranges::find(cases, link) == cases.end()) {
            cases.push_back(link);
        }
    }
    return cases;
}

ReportFigures measure_report(ReportOptions const& options, StudyOptions const& study) {
    ReportFigures figures;
    figures.commit = commit_of_source(options.quick);
    std::vector<LinkCase> const links = link_cases(options);
    RunStore store(options.folder, figures.commit,
                   options.flights.size() + options.lit_flights.size() + options.linked_scenes.size() * links.size() +
                       options.core_scenes.size() * options.cores.size() * study.methods.size());
    for (Flight const& flight : options.flights) {
        figures.live.push_back(live_run(flight, options.live, "", store));
    }
    for (Flight const& flight : options.lit_flights) {
        LiveOptions live = options.live;
        live.light = "full";
        figures.lit.push_back(live_run(flight, live, "", store));
    }
    for (auto const& scene : options.linked_scenes) {
        for (LinkCase const& link : links) {
            LiveOptions live = options.live;
            live.runs = 1;
            live.link.bits_per_second = 1e6 * link.megabits;
            live.link.delay_seconds = 0.5e-3 * link.round_trip;
            std::string const name = printed("-%gMbit-%gms", link.megabits, link.round_trip);
            figures.links.push_back({link, live_run({scene, {}}, live, name, store)});
        }
    }
    for (auto const& file : options.core_scenes) {
        run_with_cores(file, options, study, store, figures.cores);
    }
    return figures;
}

} // namespace framelet::bench
