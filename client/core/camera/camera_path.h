// A camera or a flight from a JSON file, and what of the scene goes with it. In: the file. Out: the camera at any time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/camera.h"
#include "protocol/messages/message.h"

namespace framelet {

struct CameraKey {
    double time = 0; ///< seconds since the path's start
    glm::dvec3 position{0, 0, 0}; ///< as the scene's file counts, metres
    glm::dvec3 target{0, 0, -1}; ///< a point that is in the middle of the picture; likewise
    Vec3 up{0, 1, 0}; ///< direction in the world
    float vertical_fov = 0.7854f; ///< radians
    float orthographic_height = 0; ///< metres; 0: it is a perspective camera
};

/// The moment that a camera file is of, as far as it says.
struct CameraMoment {
    std::optional<double> scene_time = {}; ///< of the scene's clock, seconds
    std::optional<bool> paused = {}; ///< the clock stands there
    std::optional<float> exposure_ev = {}; ///< as in ViewerSettings

    bool operator==(CameraMoment const&) const = default;
    /// What is asked of the clock for it; nothing where it says nothing of it.
    ClockRequest clock_request() const;
};

/// One key stands still; several are passed in order of time on a smooth curve (a cubic through every key whose
/// tangents are the chords of its neighbours), standing still before the first, after the last and between two that are
/// equal.
struct CameraPath {
    int scene_camera = -1; ///< >= 0: a camera of the scene instead of keys
    std::vector<CameraKey> keys;
    CameraMoment moment; ///< to begin with

    /// The camera so many seconds after the path's start, from the scene's origin (as in Welcome). There has to be a
    /// key.
    Camera at(double seconds, glm::dvec3 const& origin = glm::dvec3(0)) const;
    /// Seconds until the last key.
    double duration() const { return keys.empty() ? 0 : keys.back().time; }
};

/// Parses {"position": [x,y,z], "target": [x,y,z], "up": [0,1,0], "fov_degrees": 45}, where "up" and "fov_degrees" may
/// be left out and "orthographic_height" may stand in place of the latter, or {"keys": [{"time": seconds, "position":
/// ..., ...}, ...]} of perspective cameras, or {"scene_camera": 0}; each with "scene_time", "paused" and "exposure"
/// where it is of a moment. Throws InputError; `name` is for its message.
CameraPath parse_camera_path(std::string const& json, std::string const& name);

/// Reads a file and parses it likewise, or what an address of the web page has behind #camera=. Throws InputError, also
/// where the file cannot be read.
CameraPath read_camera_path(std::filesystem::path const& file);

} // namespace framelet
