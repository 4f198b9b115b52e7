// Fixture for tests of whole runs: small pictures, little time, references of their own.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/evaluation/comparison.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

inline std::filesystem::path const source = FRAMELET_SOURCE_DIR;

inline CostTable usual_costs() {
    return read_cost_table(source / "tests/evaluation/costs.json");
}

inline std::filesystem::path bundled(std::string const& name) {
    return source / "scenes" / (name + ".glb");
}

/// Parameters of a run of half a second.
inline RunParameters small_run(Viewport viewport, double reference_rate) {
    RunParameters parameters;
    parameters.viewport = viewport;
    parameters.seconds = 0.5;
    parameters.reference_rate = reference_rate;
    return parameters;
}

/// Keeps references in a folder of this test, which is removed with it.
class SmallRuns : public testing::Test {
protected:
    ~SmallRuns() override { std::filesystem::remove_all(cache); }

    StudyOptions study(RunParameters const& run) const {
        StudyOptions options;
        options.run = run;
        options.reference_cache = cache;
        options.costs = costs;
        return options;
    }
    Reference reference(BenchScene& scene, RunParameters const& run) const { return reference_of(scene, study(run)); }

    std::vector<MethodRecord> records(BenchScene& scene, std::vector<std::string> const& methods,
                                      RunParameters const& run) const {
        return compare_methods(scene, reference(scene, run), methods, run, costs).records;
    }

    /// Runs a method with what the parameters say, no choices tried out.
    RunResult show(BenchScene& scene, std::string const& method, RunParameters const& run,
                   OnReferenceTime const& on_reference_time) const {
        double const machine = machine_factor(scene, run, costs);
        return run_method(scene, *make_method(method, method_setup(run, machine, costs)), run, machine,
                          on_reference_time);
    }

    CostTable const costs = usual_costs();
    std::filesystem::path const cache =
        std::filesystem::temp_directory_path() / ("framelet-references-" + std::to_string(getpid()));
};

} // namespace framelet::bench
