// What regular and jittered places of samples give for the same number of them.
// In: scenes. Out: a table of the error that whole pictures are left with, one row a scene.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"

namespace framelet::bench {

struct AntialiasingStudy {
    std::vector<std::filesystem::path> scenes;
    Viewport viewport{512, 512};
    double time = 0.3; ///< of the animation, scene seconds
    int reference_side = 8; ///< samples along a side of a reference's pixel
};

/// A picture of uniform framelets at 1, 4 and 16 samples a pixel, on the cells' middles and jittered in the cells,
/// reconstructed as the viewer does it: PSNR against the reference, dB. Throws InputError.
nlohmann::json compare_sample_places(AntialiasingStudy const& study);

} // namespace framelet::bench
