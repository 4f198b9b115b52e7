// All that the report measures. In: what it is told. Out: plain figures, as many as the page needs.
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

/// A scene through which the viewer's own camera flies: files.
struct Flight {
    std::filesystem::path scene, camera;
};

struct ReportOptions {
    std::filesystem::path folder = "report"; ///< keeps each run's figures
    std::filesystem::path documents = FRAMELET_SOURCE_DIR "/docs"; ///< where RESULTS.md and pictures/ go
    std::vector<double> machines; ///< samples a displayed pixel and second
    std::vector<double> links; ///< bits a displayed pixel and second
    double link_machine = 10; ///< of the runs over links
    double link_delay = 0.02; ///< seconds each way
    std::vector<std::string> linked_methods; ///< of those of the study, which go over links
    std::vector<std::filesystem::path> live_scenes, clock_scenes, pictured_scenes; ///< files
    std::vector<Flight> flights; ///< that the real programs go on as well
    std::vector<std::filesystem::path> narrow_scenes; ///< that they run over `narrow` too
    LinkParameters narrow{.bits_per_second = 20e6, .delay_seconds = 0.05};
    std::vector<Flight> walks; ///< through scenes that stand still, on the virtual clock
    Viewport walk_viewport{640, 360};
    std::vector<double> turns; ///< of the camera, degrees a second
    std::vector<Viewport> clock_sizes; ///< at which the virtual clock is held against the wall's
    LiveOptions live;
    Viewport feature_viewport{1280, 720};
    bool quick = false; ///< said on the page
};

/// One method in one scene on one machine and link.
struct ReportRun {
    std::string scene, method;
    double machine = 0; ///< samples a displayed pixel and second
    double link = 0; ///< bits a displayed pixel and second; 0: no limit
    double noise = 0; ///< mean squared error of the reference itself
    double mse = 0, flip = 0, unsteadiness = 0; ///< means
    double bits = 0; ///< sent, a displayed pixel and second
    std::map<std::string, double> phases; ///< mean squared error while "moving", at an "event", when "settled"
};

struct ReportFigures {
    std::vector<ReportRun> runs;
    std::vector<ReportRun> turns; ///< while the camera turns: a "scene" is one at one speed
    std::vector<ReportRun> oracle; ///< of `oracle`, and of `framelet` beside it
    std::vector<nlohmann::json> live, narrow, clocks; ///< as measure_live returns them
    std::vector<nlohmann::json> walks; ///< as measure_own_camera returns them
    nlohmann::json features; ///< as measure_feature_costs returns them
    std::vector<std::string> pictures; ///< stems in the documents' pictures/
    std::string commit; ///< of this program
    std::set<std::string> commits; ///< of all figures
};

/// Of the machines that is which is most like two cores at 1920x1080.
double usual_machine(ReportOptions const& options);

/// Runs what `options.folder` does not have. Of `study`, scenes, methods, size, seconds and rate count.
ReportFigures measure_report(ReportOptions const& options, StudyOptions const& study);

} // namespace framelet::bench
