// The motion of a rigid body: poses at a fixed rate, a little ahead of the scene's clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/framelet/framelet_shape.h"

namespace framelet {

/// A body's pose: world from body by scale, then rotation, then translation. Bodies that shear are not rigid and have
/// velocities instead.
struct BodyPose {
    Vec3 translation{0}; ///< in the world, metres
    Quat rotation{1, 0, 0, 0};
    Vec3 scale{1};

    bool operator==(BodyPose const&) const = default;
};

/// Keys a second of scene time. Key k stands for the time k / body_keys_per_second.
inline constexpr int body_keys_per_second = 60;

/// Largest number of tracks that are given out together: so many bodies may move, each with a track of its own.
inline constexpr std::size_t max_batch_tracks = 4096;

/// Largest number of keys that all tracks which are given out together may have, so that what they take is bounded.
inline constexpr std::size_t max_batch_keys = 131072;

/// A part of a body's motion: its poses at keys that follow each other.
struct BodyTrack {
    BodyNumber body = static_body;
    std::int64_t first_key = 0; ///< number of the first key
    std::vector<BodyPose> keys;

    bool operator==(BodyTrack const&) const = default;
};

/// The number, in place of a body's, under which the track of a camera of the scene is given out.
constexpr BodyNumber camera_body(int scene_camera) {
    return static_cast<BodyNumber>(scene_camera + 1);
}

} // namespace framelet
