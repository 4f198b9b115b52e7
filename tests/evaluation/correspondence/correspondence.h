// How far off the viewer shows what it moves (003 figure 11). In: scenes. Out: a table, one row a scene and time ahead.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"

namespace framelet::bench {

struct CorrespondenceStudy {
    std::vector<std::filesystem::path> scenes;
    int camera = 0; ///< of each scene
    Viewport viewport{1280, 720};
    int times = 3; ///< along the animation
    std::vector<double> ahead{1.0 / 60, 1.0 / 15, 0.2}; ///< seconds
};

/// Framelets of a sample a pixel are rendered at one time, coded and decoded as on the wire, and shown by the viewer's
/// own code for the scene's camera at a later time. For every pixel that was visible already, the place that it was
/// taken from is compared with the exact one: primary ray, the animation's motion backwards, old camera. In a scene
/// without cameras the default one flies sideways by half of the median depth a second and turns by 30 degrees a
/// second. Throws InputError.
nlohmann::json measure_correspondence(CorrespondenceStudy const& study);

} // namespace framelet::bench
