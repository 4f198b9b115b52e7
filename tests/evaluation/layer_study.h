// What framelets look like in depth: how many are one plane or two, and what finding that out costs.
// In: scenes. Out: a table, one row a scene, over views along its animation.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"

namespace framelet::bench {

struct LayerStudy {
    std::vector<std::filesystem::path> scenes;
    Viewport viewport{1280, 720};
    int times = 5; ///< views along the animation, of each of up to two cameras of the scene and the default one
    double pixels = 0.5; ///< how far off a sample may be shown
};

/// Fits layers to the framelets of a sample per pixel, then shows every sample from a camera that has moved so far that
/// what is at median depth moves by 20 pixels and has turned by 5 degrees, at once and a tenth of a second later: by
/// its layer, and by its own depth and motion. Throws InputError.
nlohmann::json measure_layers(LayerStudy const& study);

} // namespace framelet::bench
