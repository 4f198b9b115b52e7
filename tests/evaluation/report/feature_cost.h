// Measures what each kind of scene costs the server: the same scene with one feature more each time. In: size of the
// picture. Out: processor time, rays and bytes of a sample, by the server's own pipeline.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

/// Loads the scene file and takes everything out of it that moves, mirrors, is bent or has holes; then puts these in
/// one after the other. Returns a row for each: `what`, `render_ns`, `other_ns` (choice, learning, tone curve, coding),
/// `rays` and `bytes`, all of a sample of one thread that serves `seconds` of the scene; `response_share`: the share of
/// that time that planning, mirror and learning take, without the fitting of shapes, as the table of costs has it.
/// Throws InputError.
nlohmann::json measure_feature_costs(std::filesystem::path const& scene_file, Viewport viewport, double seconds,
                                     CostTable const& costs);

} // namespace framelet::bench
