// What tests of whole runs start from: small pictures, little time, references of their own.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

#include "tests/evaluation/cost_table.h"
#include "tests/evaluation/reference.h"
#include "tests/evaluation/run.h"

namespace framelet::bench {

inline std::filesystem::path const source = FRAMELET_SOURCE_DIR;

inline CostTable usual_costs() {
    return read_cost_table(source / "tests/evaluation/costs.json");
}

/// Half a second.
inline RunParameters small_run(Viewport viewport, double reference_rate) {
    RunParameters parameters;
    parameters.viewport = viewport;
    parameters.seconds = 0.5;
    parameters.reference_rate = reference_rate;
    return parameters;
}

/// A folder of this process for references, which goes when this does.
class ReferenceFolder {
public:
    explicit ReferenceFolder(std::string const& name)
        : path_(std::filesystem::temp_directory_path() / ("framelet-" + name + "-" + std::to_string(getpid()))) {}
    ~ReferenceFolder() { std::filesystem::remove_all(path_); }
    ReferenceFolder(ReferenceFolder const&) = delete;
    ReferenceFolder& operator=(ReferenceFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }
    Reference reference(BenchScene& scene, RunParameters const& run) const {
        return {scene, {run.viewport, run.seconds, run.reference_rate, 3}, path_};
    }

private:
    std::filesystem::path path_;
};

} // namespace framelet::bench
