// `stability`: does the loop of error, density and tiling come to rest? Scenes with events (everything stops, a lamp
// switches, the camera cuts), at several batch sizes, on the virtual clock. Out: for every event how soon the error has
// settled, and how steady tiling, price and budget are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scenes/gltf_document.h"
#include "tests/evaluation/study.h"

namespace framelet::bench {

struct StabilityOptions {
    std::vector<std::string> scenes{"stop", "flicker", "teleport"}; ///< of the scene generator, with events
    std::vector<std::size_t> batches{8, 32, 128, 1024}; ///< framelets
    double factor = 2; ///< settled: within so many times the final level
};

/// Times in (0, duration) at which something jumps, or at which all that moved smoothly stands from then on. Ascending.
std::vector<double> event_times(GltfDocument const& document, double duration);

/// Whole scenes, `folder`/NAME.glb. Of `study`, methods, seconds and batch are not looked at. InputError for a scene
/// that the generator does not have.
nlohmann::json measure_stability(std::filesystem::path const& folder, StabilityOptions const& options,
                                 StudyOptions const& study);

} // namespace framelet::bench
