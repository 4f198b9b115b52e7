// What each verb of framelet-bench does with its options. In: options. Out: the figures as JSON; what is for people is
// printed. The verbs that only need a settled study are in verbs.h.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/verb_options.h"

namespace framelet::bench {

/// The project's own scene files, in the order of their names.
std::vector<std::filesystem::path> bundled_scenes();

nlohmann::json answer_table(VerbOptions& options);
nlohmann::json answer_stability(VerbOptions& options);
nlohmann::json answer_smoothness(VerbOptions& options);
nlohmann::json answer_ablation(VerbOptions& options);
nlohmann::json answer_codec(VerbOptions& options);
nlohmann::json answer_links(VerbOptions& options);
nlohmann::json answer_antialiasing(VerbOptions& options);
nlohmann::json answer_correspondence(VerbOptions& options);
nlohmann::json answer_mirrors(VerbOptions& options);
nlohmann::json answer_stillness(VerbOptions& options);
nlohmann::json answer_layers(VerbOptions& options);
nlohmann::json answer_turn(BenchScene& scene, VerbOptions& options);
nlohmann::json answer_calibrate(BenchScene& scene, VerbOptions const& options);
nlohmann::json answer_limits(BenchScene& scene, VerbOptions const& options);
nlohmann::json answer_response(BenchScene& scene, VerbOptions const& options);

} // namespace framelet::bench
