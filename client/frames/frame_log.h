// Tells of every display frame in a line of JSON: when it was shown, what the scene's clock stood at, what it had cost
// by then. For whoever compares the pictures with something else afterwards.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "common/camera.h"

namespace framelet {

struct FrameEntry {
    std::uint64_t frame = 0; ///< as in the picture's file name
    double unix_seconds = 0; ///< when the picture was shown
    double scene_seconds = 0; ///< what the scene's clock stood at, as far as the client knew
    bool changed = false; ///< the picture differs from the one before
    bool complete = false; ///< the picture is as good as it gets
    std::uint64_t bytes = 0; ///< of batches, received since the start
    double cpu_seconds = 0; ///< of the client since its start, writing of pictures apart
    std::uint64_t samples = 0; ///< received since the start
    double photon_seconds = -1; ///< as `ClientStatistics` says
    int scene_camera = -1; ///< camera of the scene that was looked through; -1: `camera`
    Camera camera; ///< the one that was asked for, from `origin`
    glm::dvec3 origin{0, 0, 0}; ///< as `Welcome::scene_origin`
};

class FrameLog {
public:
    /// Throws InputError where the file cannot be written.
    explicit FrameLog(std::filesystem::path const& file);

    /// Writes a line, which can be read at once. Throws InputError where it cannot be written.
    void add(FrameEntry const& entry);

private:
    std::filesystem::path const file_;
    std::ofstream stream_;
};

} // namespace framelet
