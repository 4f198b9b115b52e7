// Stores the report's runs, each in a file of its own: what has been run is not run again. In: a run's name and what it
// does. Out: its figures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace framelet::bench {

class RunStore {
public:
    /// Makes the folder. `commit`: that of the program, written beside each run's figures. `expected`: runs in all, for
    /// the progress that is told on stderr.
    RunStore(std::filesystem::path folder, std::string commit, std::size_t expected);

    /// Figures of the run of that name (part of a file's name), from its file or else by calling `run`.
    nlohmann::json get(std::string const& name, std::function<nlohmann::json()> const& run);

    std::filesystem::path const& folder() const { return folder_; }
    /// Commits of the programs that made the figures asked for so far.
    std::set<std::string> const& commits() const { return commits_; }

private:
    std::filesystem::path folder_;
    std::string commit_;
    std::size_t expected_, done_ = 0;
    std::set<std::string> commits_;
};

} // namespace framelet::bench
