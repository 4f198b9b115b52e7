// The 16 runs and five scenes of Table 7.2 of the dissertation (004), ours beside the published. In: the table's file,
// which runs and scenes. Out: suitable percentile, median ratio and cost of every method in every run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/study.h"

namespace framelet::bench {

struct PublishedRun {
    int number = 0;
    int batch = 0; ///< framelets
    int side = 0; ///< of the picture, pixels
    std::vector<double> suitable; ///< per cent, one a scene
};

struct PublishedTable {
    std::vector<std::string> scenes; ///< stems of the project's scene files
    std::vector<PublishedRun> runs;
};

/// Reads the table. Throws InputError that names the line.
PublishedTable read_published_table(std::filesystem::path const& file);

/// The table of these runs and scenes alone, in the order of the whole one; all where a list is empty. InputError for
/// what the table does not have.
PublishedTable part_of(PublishedTable const& table, std::vector<int> const& runs,
                       std::vector<std::string> const& scenes);

/// Every run of the table, cost counted in total as its source did. Of `study`, viewport, batch and counting are the
/// table's. Scenes are loaded from `folder`.
nlohmann::json run_table(PublishedTable const& table, std::filesystem::path const& folder, StudyOptions const& study);

} // namespace framelet::bench
