// The command line of framelet-bench's verbs. In: words. Out: options as values, with what a verb falls back on.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/evaluation/ablation.h"
#include "tests/evaluation/antialiasing.h"
#include "tests/evaluation/codec/codec_study.h"
#include "tests/evaluation/correspondence/correspondence.h"
#include "tests/evaluation/correspondence/mirror_study.h"
#include "tests/evaluation/estimators/estimator_verbs.h"
#include "tests/evaluation/layer_study.h"
#include "tests/evaluation/link_table.h"
#include "tests/evaluation/smoothness.h"
#include "tests/evaluation/stability.h"
#include "tests/evaluation/stillness.h"
#include "tests/evaluation/wall.h"

namespace CLI {
class App;
}

namespace framelet::bench {

/// Where scenes and tables come from unless told otherwise.
inline std::filesystem::path const source_folder = FRAMELET_SOURCE_DIR;

/// How much a study measures where it is not told.
struct Scale {
    int size = 512; ///< side of the picture, pixels
    double seconds = 2;
    double rate = 120; ///< measurements a second
};

/// Of all verbs; each has its part of them.
struct VerbOptions {
    std::filesystem::path scene = source_folder / "scenes/vehicle_chase.glb";
    int camera = 0;
    std::string json_file;
    std::filesystem::path costs_file = source_folder / "tests/evaluation/costs.json";
    bool quick = false;
    std::optional<Viewport> size;
    std::optional<double> seconds, rate;
    double megabits = 0;
    double delay_ms = 0;
    double jitter_ms = 0;
    bool total = false;
    std::vector<std::string> rivals_without; ///< which parts they lack
    StabilityOptions stability;
    AblationOptions ablation;
    std::vector<int> table_runs;
    std::vector<std::string> table_scenes;
    StudyOptions study;
    EstimatorStudy estimators;
    CodecStudy codec;
    std::vector<int> codec_viewport; ///< width and height; empty: what the verb has time for
    LayerStudy layers;
    AntialiasingStudy antialiasing;
    CorrespondenceStudy correspondence;
    MirrorStudy mirrors;
    SmoothnessStudy smoothness;
    StillnessStudy stillness;
    LinkTableOptions link_table;
    WallOptions wall{.server_threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1)};
};

/// Puts what was told, or else what `scale` says, into `options.study`. Throws InputError where the table of costs
/// cannot be read.
void settle(VerbOptions& options, Scale const& scale);

// The options must outlive the parsing.

void add_run_options(CLI::App& verb, VerbOptions& options);
void add_study_options(CLI::App& verb, VerbOptions& options);
void add_scene_options(CLI::App& verb, VerbOptions& options);
void add_table_options(CLI::App& verb, VerbOptions& options);
void add_link_table_options(CLI::App& verb, VerbOptions& options);
void add_stability_options(CLI::App& verb, VerbOptions& options);
void add_ablation_options(CLI::App& verb, VerbOptions& options);
void add_wall_options(CLI::App& verb, VerbOptions& options);
void add_antialiasing_options(CLI::App& verb, VerbOptions& options);
void add_layer_options(CLI::App& verb, VerbOptions& options);
void add_correspondence_options(CLI::App& verb, VerbOptions& options);
void add_mirror_options(CLI::App& verb, VerbOptions& options);
void add_smoothness_options(CLI::App& verb, VerbOptions& options);
void add_stillness_options(CLI::App& verb, VerbOptions& options);
void add_codec_options(CLI::App& verb, VerbOptions& options);
void add_response_options(CLI::App& verb, VerbOptions& options);

} // namespace framelet::bench
