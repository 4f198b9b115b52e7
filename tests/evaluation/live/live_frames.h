// Reads what the real programs leave behind: the lines that a viewer writes for its frames, and the processor time of a
// process.
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
    double seconds = 0; ///< time of display, Unix seconds
    SceneTime scene_time = 0; ///< scene time that was to be shown
    bool changed = false;
    double bytes = 0, samples = 0, cpu_seconds = 0, photon_seconds = -1;
    Camera camera; ///< camera that was to be shown, unless `scene_camera` is not -1
    int scene_camera = -1;
};

/// Reads the file that `--frames` names. Leaves out a last line that is not whole.
std::vector<LiveFrame> read_frames(std::filesystem::path const& file);

/// Seconds of processor time that a process has used; 0 where there is none.
double cpu_of(pid_t pid);

/// The value below which this share of the values lies; 0 of none.
double percentile(std::vector<double> values, double share);

} // namespace framelet::bench
