// What becomes of mirror reflections that the viewer moves. In: scenes. Out: a table, one row a scene and time ahead.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/camera.h"

namespace framelet::bench {

struct MirrorStudy {
    std::vector<std::filesystem::path> scenes;
    int camera = 0; ///< of each scene
    Viewport viewport{1280, 720};
    int times = 3; ///< along the animation
    std::vector<double> ahead{1.0 / 60, 1.0 / 15, 0.2}; ///< seconds
};

/// A picture of a sample a pixel is rendered at one time, coded and decoded as on the wire, and shown by the viewer's
/// own code for a later time: moved, and as it is. Mean squared errors against what is rendered then, apart for pixels
/// that show a traced reflection then and all others. The camera is the scene's; where that stands still it flies.
/// Throws InputError.
nlohmann::json measure_mirrors(MirrorStudy const& study);

} // namespace framelet::bench
