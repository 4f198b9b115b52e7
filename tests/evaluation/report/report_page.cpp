#include "tests/evaluation/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "common/error.h"
#include "tests/evaluation/report/goals.h"
#include "tests/evaluation/report/live_tables.h"
#include "tests/evaluation/report/report_charts.h"
#include "tests/evaluation/report/report_text.h"
#include "tests/evaluation/scene_events.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr char const* phases[] = {"moving", "event", "settled"};

/// Ratio of the project's error to that of the best rival in a phase, and that rival.
struct Ratio {
    double value = NAN;
    std::string rival;
};

Ratio ratio_of(std::vector<ReportRun> const& runs, std::string const& scene, std::string const& own,
               std::string const& phase) {
    double mine = NAN, least = INFINITY;
    std::string rival;
    for (ReportRun const& run : runs) {
        auto const error = run.phases.find(phase);
        if (run.scene != scene || error == run.phases.end()) {
            continue;
        }
        if (run.method == own) {
            mine = error->second;
        } else if (is_rival(run.method) && error->second < least) {
            least = error->second;
            rival = run.method;
        }
    }
    bool const has_both = std::isfinite(mine) && std::isfinite(least);
    return {has_both ? std::max(mine, least_mse) / std::max(least, least_mse) : NAN, rival};
}

std::string cell(Ratio const& ratio) {
    return std::isnan(ratio.value) ? "-" : bold_if(ratio.value > 1, printed("%.2f", ratio.value)) + " " + ratio.rival;
}

std::string ratio_table(std::vector<ReportRun> const& runs) {
    std::string text = "| scene | moving | event | settled | without reprojection: moving | event | settled |\n"
                       "|---|---|---|---|---|---|---|\n";
    std::size_t lost = 0, all = 0;
    std::vector<double> moving;
    for (std::string const& scene : distinct(runs, &ReportRun::scene)) {
        text += "| `" + scene + "` |";
        for (char const* const own : {"framelet", "framelet-unwarped"}) {
            for (char const* const phase : phases) {
                Ratio const ratio = ratio_of(runs, scene, own, phase);
                text += printed(" %s |", cell(ratio).c_str());
                bool const counts = own == std::string("framelet") && !std::isnan(ratio.value);
                all += counts ? 1 : 0;
                lost += counts && ratio.value > 1 ? 1 : 0;
                if (counts && phase == std::string("moving")) {
                    moving.push_back(ratio.value);
                }
            }
        }
        text += "\n";
    }
    text += printed("\nLost: %zu of %zu.", lost, all);
    if (!moving.empty()) {
        text += printed(" Median while something moves: %.2f.", median(moving));
    }
    return text + "\n";
}

std::string feature_table(json const& rows) {
    std::string text = "| `stop` | render, ns | all else, ns | rays | bytes |\n|---|---|---|---|---|\n";
    for (json const& row : rows) {
        text += printed("| %s | %.0f | %.0f | %.2f | %.2f |\n", row["what"].get<std::string>().c_str(),
                        row["render_ns"].get<double>(), row["other_ns"].get<double>(), row["rays"].get<double>(),
                        row["bytes"].get<double>());
    }
    return text;
}

/// Table of errors: a row for each method, a column for each machine.
std::string speed_table(ReportFigures const& figures) {
    std::string text = "| samples a pixel and second |", line = "|---|";
    for (double const machine : distinct(unlimited(figures.runs), &ReportRun::machine)) {
        text += printed(" %g |", machine);
        line += "---|";
    }
    text += "\n" + line + "\n";
    for (Curve const& curve : speed_chart(figures).curves) {
        text += "| `" + curve.name + "` |";
        for (double const y : curve.y) {
            text += printed(" %.1f |", y);
        }
        text += "\n";
    }
    return text;
}

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "an unknown processor";
}

std::string names_of(std::set<std::string> const& commits) {
    std::string text;
    for (std::string const& commit : commits) {
        text += (text.empty() ? "" : ", ") + commit;
    }
    return text;
}

} // namespace

std::string report_page(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                        std::string const& command) {
    RunParameters const& run = study.run;
    double const machine = usual_machine(options);
    auto const at = [&](double wanted_machine, double link) {
        return part(figures.runs, [=](ReportRun const& r) { return r.machine == wanted_machine && r.link == link; });
    };
    std::string page = "# Results\n\n    " + command + "\n\n";
    page += "Commit " + names_of(figures.commits) +
            printed(", %u cores of %s.", std::thread::hardware_concurrency(), processor_name().c_str());
    page +=
        printed(" Virtual clock: %zu scenes at %dx%d, %g s that see each scene's events, %g measurements a second.\n",
                study.scenes.size(), run.viewport.width, run.viewport.height, run.seconds, run.reference_rate);
    page +=
        "Methods, machine, link and measures are explained in [tests/evaluation](../tests/evaluation/README.md); each "
        "rival has the spacing and margin with which it errs least. ";
    page += options.quick ? "This is the quick run: it shows that the report works, and nothing else.\n" : "\n";

    page += "\n## Goals\n\n" + goals_table(goals_of(figures)) +
            "\nWhat stands in the way of those that are not met: [SHORTFALLS.md](SHORTFALLS.md).\n";

    page += "\n## Speed against accuracy\n\n![error against speed](pictures/speed.png)\n\n" + speed_table(figures);
    page += printed("\nMean squared error over that of the reference itself (%d samples a pixel), geometric mean over "
                    "scenes. A core is taken to shade %.1f million samples a second, as it does with a shadow ray each "
                    "and mirrors here and there; the link has no limit.\n",
                    study.samples_per_side * study.samples_per_side, core_rate / 1e6);
    page += "\n![FLIP](pictures/flip.png)\n![unsteadiness](pictures/steadiness.png)\n";
    if (!options.links.empty()) {
        page += printed("\nOver links of several rates, %g ms each way, a machine of %g samples a pixel and second:\n",
                        1e3 * options.link_delay, options.link_machine);
        page += "\n![error against bits](pictures/bits.png)\n";
    }

    page +=
        printed("\n## Against the best rival, scene by scene\n\nMSE of `framelet` over that of whichever rival errs "
                "least in that phase; above 1, in bold, is a loss. An event lasts %g s.\n\n### %g samples a pixel "
                "and second (1080p on two cores), no limit of the link\n\n",
                event_seconds, machine);
    page += ratio_table(at(machine, 0));
    if (!options.links.empty()) {
        double const link = options.links[options.links.size() / 2];
        page += printed("\n### %g samples a pixel and second, %g bits a pixel and second, %g ms each way\n\n",
                        options.link_machine, link, 1e3 * options.link_delay);
        page += ratio_table(at(options.link_machine, link));
    }
    if (!figures.live.empty()) {
        page += printed(
            "\n## The real programs\n\n`framelet-bench live` at %dx%d for %g s: server and viewer on the same "
            "cores, a real socket, the clock running; compared at %d moments. Figures are of `framelet` / the same "
            "without reprojection / the rival that errs least (in brackets the spacing of its frames), the best in "
            "bold.\n\n![error against pictures a second](pictures/live.png)\n\n",
            options.live.viewport.width, options.live.viewport.height, options.live.seconds, options.live.moments);
        page += live_table(figures.live);
    }
    if (!figures.narrow.empty()) {
        page += printed("\n### Over %g Mbit/s, %g ms each way\n\n", options.narrow.bits_per_second / 1e6,
                        1e3 * options.narrow.delay_seconds) +
                live_table(figures.narrow);
    }
    if (!figures.clocks.empty()) {
        page += "\n### The same sessions on the virtual clock\n\n`framelet` with a core for the server and one for the "
                "viewer. PSNR is by the wall clock; then comes how much more the virtual clock says, and its bytes and "
                "pictures over the wall clock's. Busy is how much the server's core was by the wall clock, and without "
                "reprojection. Far ones in bold.\n\n";
        page += clock_table(figures.clocks);
    }
    page +=
        printed("\n## What each kind of scene costs\n\nA sample of a session at %dx%d, one thread: the scene `stop`, "
                "with one thing more in each row. While nothing moves the picture is refined, at last with four rays a "
                "sample, and what it has is not sent again.\n\n",
                options.feature_viewport.width, options.feature_viewport.height);
    return wrapped(page + feature_table(figures.features));
}

void write_report(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                  std::string const& command) {
    draw_report_charts(figures, options.documents / "pictures");
    auto const file = options.documents / "RESULTS.md";
    std::ofstream stream(file);
    stream << report_page(figures, options, study, command);
    if (!stream.flush()) {
        throw InputError("cannot write '" + file.string() + "'");
    }
    std::printf("%s\n", file.c_str());
}

} // namespace framelet::bench
