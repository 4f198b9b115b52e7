// Runs all that the report measures. In: its options. Out: plain figures, as many as the page needs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/evaluation/live/live.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

/// A scene, and the camera file by which the viewer's own camera flies through it; without one it looks through the
/// scene's camera.
struct Flight {
    std::filesystem::path scene, camera;
};

/// A link: its rate, Mbit/s, and the time of a round trip over it, ms.
struct LinkCase {
    double megabits = 0, round_trip = 0;

    bool operator==(LinkCase const&) const = default;
};

struct ReportOptions {
    std::filesystem::path folder = "report"; ///< keeps each run's figures
    std::filesystem::path documents = FRAMELET_SOURCE_DIR "/docs"; ///< folder of RESULTS.md and pictures/
    std::vector<Flight> flights; ///< of the real programs, with no link between them
    std::vector<Flight> lit_flights; ///< likewise, with full light, against paths
    std::vector<std::filesystem::path> linked_scenes; ///< scenes that they run over links
    std::vector<double> rates{5, 20, 100}; ///< Mbit/s, each with `usual.round_trip`
    std::vector<double> round_trips{0, 20, 200}; ///< ms, each with `usual.megabits`
    LinkCase usual{20, 20};
    LiveOptions live; ///< how the real programs run; `runs` of them without a link, one over each
    std::vector<std::filesystem::path> core_scenes; ///< scenes that run with each number of cores
    std::vector<int> cores{2, 8, 32}; ///< servers' cores on the virtual clock
    Viewport screen{1920, 1080}; ///< size of the picture for which these cores are
    bool quick = false; ///< quick, incomplete runs, of any state of the source; the page says so
};

/// What the real programs did in one scene over one link.
struct LinkRun {
    LinkCase link;
    nlohmann::json figures; ///< as `measure_live` returns them
};

/// One method in one scene with so many cores, on the virtual clock.
struct CoreRun {
    std::string scene, method;
    int cores = 0;
    double mse = 0;
};

struct ReportFigures {
    std::vector<nlohmann::json> live, lit; ///< as `measure_live` returns them
    std::vector<LinkRun> links;
    std::vector<CoreRun> cores;
    std::string commit; ///< of which all of them are
};

/// Shaded samples a second of one core where every sample has a shadow ray and a quarter mirror; the bundled scenes
/// reach a third to a half of it.
inline constexpr double core_rate = 5.3e6;

/// Each link of the options once, those of different rates first.
std::vector<LinkCase> link_cases(ReportOptions const& options);

/// Runs what `options.folder` does not have of this commit. Of `study` only methods, size, seconds and rate
/// count. Throws InputError where the source has changes that are not committed, but for a quick report.
ReportFigures measure_report(ReportOptions const& options, StudyOptions const& study);

} // namespace framelet::bench
