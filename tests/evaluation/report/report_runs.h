// Runs all that the report measures. In: its options. Out: plain figures, as many as the page needs.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/evaluation/live/live.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

/// A scene and the camera file by which the viewer's own camera flies through it.
struct Flight {
    std::filesystem::path scene, camera;
};

struct ReportOptions {
    std::filesystem::path folder = "report"; ///< folder that keeps each run's figures
    std::filesystem::path documents = FRAMELET_SOURCE_DIR "/docs"; ///< folder of RESULTS.md and pictures/
    std::vector<double> machines; ///< speeds of machines, samples a displayed pixel and second
    std::vector<double> links; ///< rates of links, bits a displayed pixel and second
    double link_machine = 10; ///< machine of the runs over links, samples a displayed pixel and second
    double link_delay = 0.02; ///< delay of links, seconds each way
    std::vector<std::string> linked_methods; ///< methods of the study that also run over links
    std::vector<std::filesystem::path> live_scenes, clock_scenes; ///< files
    std::vector<Flight> flights; ///< flights on which the real programs go as well
    std::vector<std::filesystem::path> narrow_scenes; ///< scenes that the real programs run over `narrow` too
    LinkParameters narrow{.bits_per_second = 20e6, .delay_seconds = 0.05};
    std::vector<Flight> walks; ///< through scenes that stand still, on the virtual clock
    Viewport walk_viewport{640, 360};
    std::vector<double> turns; ///< turning of the camera, degrees a second
    std::vector<Viewport> clock_sizes; ///< sizes at which the virtual clock is compared with the wall clock
    LiveOptions live;
    Viewport feature_viewport{1280, 720};
    bool quick = false; ///< quick, incomplete runs; the page says so
};

/// One method in one scene on one machine and link.
struct ReportRun {
    std::string scene, method;
    double machine = 0; ///< samples a displayed pixel and second
    double link = 0; ///< bits a displayed pixel and second; 0: no limit
    double noise = 0; ///< mean squared error of the reference itself
    double mse = 0, flip = 0, unsteadiness = 0; ///< means over the reference times
    double bits = 0; ///< bits sent, a displayed pixel and second
    std::map<std::string, double> phases; ///< mean squared error while "moving", at an "event", when "settled"
};

struct ReportFigures {
    std::vector<ReportRun> runs;
    std::vector<ReportRun> turns; ///< runs while the camera turns: a "scene" is a scene at one speed
    std::vector<nlohmann::json> live, narrow, clocks; ///< as measure_live returns them
    std::vector<nlohmann::json> walks; ///< as measure_own_camera returns them
    nlohmann::json features; ///< as measure_feature_costs returns them
    std::string commit; ///< commit of this program
    std::set<std::string> commits; ///< commits of the programs that made the figures
};

/// The machine of `options.machines` that is most like two cores at 1920x1080.
double usual_machine(ReportOptions const& options);

/// Runs what `options.folder` does not have. Of `study` only scenes, methods, size, seconds and rate count.
ReportFigures measure_report(ReportOptions const& options, StudyOptions const& study);

} // namespace framelet::bench
