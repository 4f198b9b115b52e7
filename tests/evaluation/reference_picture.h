// One picture of a scene by paths of light, or as the server shades it, to be looked at and compared. In: a scene, a
// camera. Out: a file, what it took, and how far the server's light is off the paths.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "server/render/path/path_options.h"
#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct ReferencePictureOptions {
    std::filesystem::path camera; ///< camera file as framelet-client takes it, at its start; empty: the scene's own
    std::filesystem::path environment; ///< map that lights the scene; empty: none
    /// PNG as viewers show it, or EXR of radiance. Beside a PNG of paths the server's own picture can be made with
    /// `direct`, at the same exposure.
    std::filesystem::path output = "reference.png";
    bool direct = false; ///< as the server shades it, without paths; no EXR
    bool full = false; ///< likewise, with the light cache, and beside the paths: how far off both are
    /// With `full`: the scene has moved for so long when the picture is made, and so many paths of each second were
    /// gathered meanwhile. 0: it stands, and all that is seen is good enough.
    double moved_seconds = 0;
    double gathered_per_second = 1e5;
    float sun_degrees = 0, lamp_metres = 0; ///< diameters; 0: hard
    PathOptions paths;
};

/// Writes the picture at this scene time. Throws InputError.
nlohmann::json write_reference_picture(std::filesystem::path const& scene, Viewport viewport, SceneTime time,
                                       ReferencePictureOptions const& options);

} // namespace framelet::bench
