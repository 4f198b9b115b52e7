#include "tests/evaluation/gate.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/phases.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double machines[] = {2, 20}; ///< samples a displayed pixel and second
constexpr double most_growth = 1.05; ///< of the geometric mean over the scenes
constexpr char const* all_scenes = "all, geometric mean";

/// Mean squared error over pictures and phases.
double mean_error(Subject const& subject, CostTable const& costs) {
    auto const pictures = static_cast<double>(reference_count(subject.run));
    double sum = 0;
    for (std::size_t phase = 0; phase < phases; ++phase) {
        MethodSetup setup = method_setup(subject.run, subject.machine, costs);
        setup.clock_offset += phase_step * static_cast<double>(phase);
        auto const method = make_method("framelet", setup);
        run_method(*subject.scene, *method, subject.run, subject.machine,
                   [&](std::size_t index, Picture const& shown, double) {
                       sum += mean_squared_error(shown, subject.reference.picture(index)) / pictures;
                   });
    }
    return sum / static_cast<double>(phases);
}

json read_figures(std::filesystem::path const& file) {
    std::ifstream stream(file);
    json figures = json::parse(stream, nullptr, false);
    if (!figures.is_object()) {
        throw InputError("cannot read '" + file.string() + "'");
    }
    return figures;
}

} // namespace

json measure_gate(StudyOptions const& study, std::filesystem::path const& file, bool write) {
    json found;
    for (double const machine : machines) {
        std::string const name = std::to_string(std::lround(machine));
        double logarithms = 0;
        for (auto const& scene : study.scenes) {
            StudyOptions options = study;
            options.run.frames_per_second = machine;
            Subject const subject = prepare(scene, options);
            double const mse = mean_error(subject, study.costs);
            found[name][subject.scene->name] = mse;
            logarithms += std::log(mse) / static_cast<double>(study.scenes.size());
        }
        found[name][all_scenes] = std::exp(logarithms);
    }
    if (write) {
        std::ofstream stream(file);
        stream << found.dump(2) << '\n';
        if (!stream.flush()) {
            throw InputError("cannot write '" + file.string() + "'");
        }
    }
    json const committed = read_figures(file);
    json rows = json::array();
    for (auto const& [machine, scenes] : found.items()) {
        for (auto const& [scene, value] : scenes.items()) {
            if (!committed.contains(machine) || !committed[machine].contains(scene)) {
                throw InputError("'" + file.string() + "' lacks " + scene + " at " + machine + " samples: --write");
            }
            double const before = committed[machine][scene], after = value;
            bool const worse = scene == all_scenes && after > most_growth * before;
            std::printf("%-20s %2s samples a pixel and second: mse %.6e, was %.6e, %.3f times%s\n", scene.c_str(),
                        machine.c_str(), after, before, after / before, worse ? ": WORSE" : "");
            rows.push_back({{"scene", scene},
                            {"machine", machine},
                            {"before", before},
                            {"after", after},
                            {"failures", json::array()}});
            if (worse) {
                rows.back()["failures"].push_back("worse");
            }
        }
    }
    return rows;
}

} // namespace framelet::bench
