// Stores the report's runs, each in a file of its own: what this commit has run is not run again. In: a run's name and
// what it does. Out: its figures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace framelet::bench {

class RunStore {
public:
    /// Makes the folder. `commit`: that of the program. `expected`: runs in all, for the progress that is told on
    /// stderr.
    RunStore(std::filesystem::path folder, std::string commit, std::size_t expected);

    /// Figures of the run of that name (part of a file's name), from its file where that is of the same commit, or else
    /// by calling `run`.
    nlohmann::json get(std::string const& name, std::function<nlohmann::json()> const& run);

private:
    std::filesystem::path folder_;
    std::string commit_;
    std::size_t expected_, done_ = 0;
};

} // namespace framelet::bench
