// What the real programs leave behind: the lines that a viewer writes for its frames, and what a process used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <sys/types.h>

#include "common/camera.h"
#include "common/framelet/framelet.h"

namespace framelet::bench {

struct LiveFrame {
    std::uint64_t number = 0;
    double seconds = 0; ///< Unix
    SceneTime scene_time = 0; ///< that was to be shown
    bool changed = false;
    double bytes = 0, samples = 0, cpu_seconds = 0, photon_seconds = -1;
    Camera camera; ///< that was to be shown, unless the scene's was
    int scene_camera = -1;
};

/// Of the file that `--frames` names. A line that is not whole is left out.
std::vector<LiveFrame> read_frames(std::filesystem::path const& file);

/// Seconds of processor time that a process has used; 0 where there is none.
double cpu_of(pid_t pid);

/// The value below which this share of them is; 0 of none.
double percentile(std::vector<double> values, double share);

} // namespace framelet::bench
