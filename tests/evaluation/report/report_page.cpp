#include "tests/evaluation/report/report_page.h"

#include <cstdio>
#include <fstream>
#include <thread>

#include "common/error.h"
#include "tests/evaluation/report/report_charts.h"
#include "tests/evaluation/report/report_tables.h"
#include "tests/evaluation/report/report_text.h"

namespace framelet::bench {
namespace {

std::string processor_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "an unknown processor";
}

std::string live_section(ReportFigures const& figures, LiveOptions const& live) {
    return printed("\n## The real programs\n\nServer and viewer on the same cores, a real socket, the clock running: "
                   "%dx%d, %g s, compared at %d moments. Each method ran %d times; the run of median error counts, and "
                   "the spread is that of all. Figures are of `framelet` / the rival that errs least, in brackets the "
                   "spacing of its frames; what is lost is in bold.\n\n![real programs](pictures/live.png)\n\n",
                   live.viewport.width, live.viewport.height, live.seconds, live.moments, live.runs) +
           live_table(figures.live);
}

std::string lit_section(ReportFigures const& figures, LiveOptions const& live) {
    return printed(
               "\n## With all light\n\nThe same programs with `--light full`; the rivals have the same light cache. "
               "Errors are against %d paths a pixel, whose noise counts for all alike.\n\n",
               live.paths) +
           live_table(figures.lit);
}

std::string links_section(ReportFigures const& figures) {
    return "\n## Over links\n\nThe same programs with a link between them, one run each: PSNR in dB.\n\n"
           "![links](pictures/links.png)\n\n" +
           links_table(figures.links);
}

std::string cores_section(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study) {
    RunParameters const& run = study.run;
    return printed("\n## More processors\n\nOn the virtual clock, at %dx%d, for %g s that see each scene's events. So "
                   "many cores render as many samples a pixel and second as they would at %dx%d, if a core shades %.1f "
                   "million a second. Error of `framelet` over that of the rival that errs least.\n\n"
                   "![processors](pictures/cores.png)\n\n",
                   run.viewport.width, run.viewport.height, run.seconds, options.screen.width, options.screen.height,
                   core_rate / 1e6) +
           cores_table(figures.cores);
}

} // namespace

std::string report_page(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                        std::string const& command) {
    std::string page = "# Results\n\n    " + command + "\n\nCommit " + figures.commit +
                       printed(", %u cores of %s. ", std::thread::hardware_concurrency(), processor_name().c_str());
    page += "Methods, machine, link and measures are explained in [tests/evaluation](../tests/evaluation/README.md); "
            "each rival has the spacing and margin with which it errs least. ";
    page += options.quick ? "This is the quick run: it shows that the report works, and nothing else.\n" : "\n";
    page += "\n## Goals\n\n" + goals_table(figures) +
            "\nWhat stands in the way of those that are not met: [SHORTFALLS.md](SHORTFALLS.md).\n";
    page += figures.live.empty() ? "" : live_section(figures, options.live);
    page += figures.lit.empty() ? "" : lit_section(figures, options.live);
    page += figures.links.empty() ? "" : links_section(figures);
    page += figures.cores.empty() ? "" : cores_section(figures, options, study);
    return wrapped(page);
}

void write_report(ReportFigures const& figures, ReportOptions const& options, StudyOptions const& study,
                  std::string const& command) {
    draw_report_charts(figures, options);
    auto const file = options.documents / "RESULTS.md";
    std::ofstream stream(file);
    stream << report_page(figures, options, study, command);
    if (!stream.flush()) {
        throw InputError("cannot write '" + file.string() + "'");
    }
    std::printf("%s\n", file.c_str());
}

} // namespace framelet::bench
