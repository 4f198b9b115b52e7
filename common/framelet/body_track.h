// How a rigid body moves: poses at a fixed rate, a little ahead of the scene's clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/framelet/framelet_shape.h"

namespace framelet {

/// World from body: scale, then rotation, then translation. Bodies that shear are not rigid and have velocities
/// instead.
struct BodyPose {
    Vec3 translation{0};
    Quat rotation{1, 0, 0, 0};
    Vec3 scale{1};

    bool operator==(BodyPose const&) const = default;
};

/// Keys a second of scene time. Key k stands for the time k / body_keys_per_second.
inline constexpr int body_keys_per_second = 60;

/// Of all tracks that are given out together: what they take is bounded.
inline constexpr std::size_t max_batch_keys = 131072;

struct BodyTrack {
    BodyNumber body = static_body;
    std::int64_t first_key = 0;
    std::vector<BodyPose> keys;

    bool operator==(BodyTrack const&) const = default;
};

/// Under which number a track is of a camera of the scene, and not of a body.
constexpr BodyNumber camera_body(int scene_camera) {
    return static_cast<BodyNumber>(scene_camera + 1);
}

} // namespace framelet
