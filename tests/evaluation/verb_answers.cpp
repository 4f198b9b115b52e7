#include "tests/evaluation/verb_answers.h"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/calibrate.h"
#include "tests/evaluation/limits.h"
#include "tests/evaluation/link_turn.h"
#include "tests/evaluation/response_cost.h"
#include "tests/evaluation/table.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

std::vector<std::filesystem::path> named_scenes(std::initializer_list<char const*> names) {
    std::vector<std::filesystem::path> files;
    for (std::string const name : names) {
        files.push_back(source_folder / ("scenes/" + name + ".glb"));
    }
    return files;
}

/// Whole frames as they are sent, the same moved by the viewer, and the project's own.
std::vector<std::string> const streamed_methods{"framed+h264", "framed+warp", "framelet"};

} // namespace

std::vector<std::filesystem::path> bundled_scenes() {
    std::vector<std::filesystem::path> files;
    for (auto const& entry : std::filesystem::directory_iterator(source_folder / "scenes")) {
        if (entry.path().extension() == ".glb") {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

json answer_table(VerbOptions& options) {
    settle(options, {.seconds = 5, .rate = 10}); // the whole of every scene
    if (options.study.methods.empty()) {
        options.study.methods = {"afr", "framelet-unwarped"}; // cost is total: a display rate is none of its terms
    }
    auto const published = read_published_table(source_folder / "tests/evaluation/published_table_7_2.csv");
    auto part = part_of(published, options.table_runs, options.table_scenes);
    if (options.quick) {
        std::erase_if(part.runs, [](PublishedRun const& run) { return run.side > 256; });
    }
    if (part.runs.empty()) {
        throw InputError("--quick leaves none of these runs: it takes those of 256x256 pixels alone");
    }
    return run_table(part, source_folder / "scenes", options.study);
}

json answer_turn(BenchScene& scene, VerbOptions& options) {
    settle(options, options.quick ? Scale{.size = 128, .seconds = 1, .rate = 60} : Scale{.size = 256, .rate = 60});
    if (options.study.methods.empty()) {
        options.study.methods = streamed_methods;
    }
    return turn_study(scene, options.study);
}

json answer_stability(VerbOptions& options) {
    settle(options, options.quick ? Scale{.size = 96, .rate = 20} : Scale{.size = 256, .rate = 40});
    return measure_stability(source_folder / "scenes", options.stability, options.study);
}

json answer_smoothness(VerbOptions& options) {
    settle(options, options.quick ? Scale{.size = 96, .seconds = 0.5, .rate = 60}
                                  : Scale{.size = 192, .seconds = 1, .rate = 60});
    auto& scenes = options.smoothness.scenes;
    if (scenes.empty()) {
        scenes = named_scenes({"vehicle_chase", "windmill", "flicker", "globe"});
    }
    return measure_smoothness(options.smoothness, options.study);
}

json answer_ablation(VerbOptions& options) {
    settle(options, options.quick ? Scale{.size = 128, .seconds = 0.5, .rate = 60} : Scale{.size = 256, .seconds = 1});
    auto& scenes = options.ablation.scenes;
    if (scenes.empty()) {
        scenes = named_scenes({"vehicle_chase", "vehicle_flyby", "vehicle_fixed", "stop", "windmill", "globe", "dim"});
    }
    return measure_ablation(options.ablation, options.study);
}

json answer_codec(VerbOptions& options) {
    CodecStudy& study = options.codec;
    if (study.scenes.empty()) {
        study.scenes =
            named_scenes({"vehicle_approach", "vehicle_chase", "vehicle_crossing", "vehicle_fixed", "vehicle_flyby"});
    }
    if (options.quick) {
        study.corpus.viewport = {640, 360};
        study.corpus.moments = 1;
        study.rounds = 1;
    }
    if (!options.codec_viewport.empty()) {
        study.corpus.viewport = {options.codec_viewport[0], options.codec_viewport[1]};
    }
    return compare_codecs(study);
}

json answer_links(VerbOptions& options) {
    settle(options, options.quick ? Scale{.size = 96, .seconds = 0.5, .rate = 20}
                                  : Scale{.size = 256, .seconds = 1, .rate = 30});
    if (options.link_table.scenes.empty()) {
        options.link_table.scenes = bundled_scenes();
    }
    return link_table(options.link_table, options.study);
}

json answer_antialiasing(VerbOptions& options) {
    auto& study = options.antialiasing;
    if (study.scenes.empty()) {
        study.scenes = bundled_scenes();
    }
    if (options.quick) {
        study.viewport = {256, 256};
    }
    return compare_sample_places(study);
}

json answer_correspondence(VerbOptions& options) {
    auto& study = options.correspondence;
    if (study.scenes.empty()) {
        study.scenes = named_scenes({"globe", "windmill", "vehicle_approach", "vehicle_chase", "vehicle_crossing",
                                     "vehicle_fixed", "vehicle_flyby"});
    }
    if (options.quick) {
        study.viewport = {640, 360};
        study.times = 1;
    }
    return measure_correspondence(study);
}

json answer_mirrors(VerbOptions& options) {
    auto& study = options.mirrors;
    if (study.scenes.empty()) {
        study.scenes = named_scenes({"globe", "stop", "vehicle_chase", "vehicle_flyby"});
    }
    if (options.quick) {
        study.viewport = {640, 360};
        study.times = 1;
    }
    return measure_mirrors(study);
}

json answer_stillness(VerbOptions& options) {
    settle(options,
           options.quick ? Scale{.size = 128, .seconds = 2, .rate = 20} : Scale{.size = 512, .seconds = 4, .rate = 20});
    if (options.stillness.scenes.empty()) {
        options.stillness.scenes = bundled_scenes();
    }
    return measure_stillness(options.stillness, options.study);
}

json answer_layers(VerbOptions& options) {
    auto& study = options.layers;
    if (study.scenes.empty()) {
        study.scenes = bundled_scenes();
    }
    if (options.quick) {
        study.viewport = {640, 360};
        study.times = 2;
    }
    return measure_layers(study);
}

json answer_calibrate(BenchScene& scene, VerbOptions const& options) {
    json const costs = to_json(calibrate(scene, {512, 512}, options.quick ? 3 : 15));
    for (auto const& [name, cost] : costs.items()) {
        std::printf("%-26s %8.2f ns\n", name.c_str(), cost.get<double>());
    }
    return costs;
}

json answer_limits(BenchScene& scene, VerbOptions const& options) {
    LimitsOptions limits;
    if (options.quick) {
        limits = {{640, 360}, 3};
    }
    return measure_limits(scene, limits);
}

json answer_response(BenchScene& scene, VerbOptions const& options) {
    ResponseStudy sizes{.charts = options.study.charts};
    if (options.quick) {
        sizes.sides = {256, 1024};
        sizes.seconds = 0.3;
    }
    return measure_response(scene, sizes);
}

} // namespace framelet::bench
