// The command line of framelet-bench. In: words. Out: options as values. All verbs but those of real programs take the
// same options; each verb has its own defaults.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/evaluation/reference_picture.h"
#include "tests/evaluation/report/report_runs.h"
#include "tests/evaluation/study.h"

namespace CLI {
class App;
}

namespace framelet::bench {

/// Folder from which scenes and tables come unless told otherwise.
inline std::filesystem::path const source_folder = FRAMELET_SOURCE_DIR;

/// Default amounts of a verb's measurement.
struct Scale {
    Viewport viewport{640, 360};
    double seconds = 2;
    double rate = 60; ///< measurements a second
};

struct VerbOptions {
    std::string command; ///< the command as it was typed, without the folders
    std::filesystem::path json_file;
    std::filesystem::path costs_file = source_folder / "tests/evaluation/costs.json";
    bool quick = false;
    std::vector<std::string> scenes; ///< files, or names of bundled ones
    std::optional<Viewport> size;
    std::optional<double> start, seconds, rate;
    double megabits = 0;
    double delay_ms = 0;
    std::filesystem::path link_file; ///< a link instead of these two; empty: none
    std::vector<double> round_trips; ///< of `compare`, ms; empty: that of the link alone
    bool total = false;
    std::vector<std::string> rivals_without; ///< parts that the rivals lack
    StudyOptions study;

    // The options below belong to one verb each.
    std::vector<int> table_runs;
    std::vector<std::string> without; ///< parts that the ablation leaves out
    ReferencePictureOptions reference_picture; ///< for `reference`
    ReportOptions report;
    std::filesystem::path assets; ///< folder of models, for the report's flights; empty: none
    bool without_live = false;
    std::filesystem::path gate_file = source_folder / "tests/evaluation/gate.json";
    bool write_gate = false;
    std::vector<int> threads; ///< of `limits`; empty: all, beside the bare loop
};

/// The project's own scene files, in the order of their names.
std::vector<std::filesystem::path> bundled_scenes();

/// Files in a folder with that extension, in the order of their names.
std::vector<std::filesystem::path> files_in(std::filesystem::path const& folder, char const* extension);

/// Path of a scene: the file itself, or else the bundled scene of that name.
std::filesystem::path scene_file(std::string const& file_or_name);

/// Puts the options that were given, or else the defaults of `scale` and `scenes` (names; empty: all bundled ones),
/// into `options.study`. Throws InputError where the table of costs cannot be read.
void settle(VerbOptions& options, Scale const& scale, std::vector<std::string> const& scenes);

// The options that these functions bind must outlive the parsing.

/// Adds the options of a link: rate in Mbit/s, delay each way in ms.
void add_link_options(CLI::App& verb, double& megabits, double& delay_ms);

/// Adds the options that verbs share.
void add_study_options(CLI::App& verb, VerbOptions& options);

void add_compare_options(CLI::App& verb, VerbOptions& options);
void add_ablation_options(CLI::App& verb, VerbOptions& options);
void add_table_options(CLI::App& verb, VerbOptions& options);
void add_gate_options(CLI::App& verb, VerbOptions& options);
void add_reference_picture_options(CLI::App& verb, VerbOptions& options);
void add_limits_options(CLI::App& verb, VerbOptions& options);
void add_report_options(CLI::App& verb, VerbOptions& options);

} // namespace framelet::bench
