#include "client/core/camera/camera_track.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "common/framelet/body_motion.h"

namespace framelet {
namespace {

/// A step is a cut where it is more than so many times as large as the steps beside it: a camera that starts or stops
/// within one key goes no faster.
constexpr float cut_factor = 4;
/// The least step, metres, and the least turn, as the sine of half its angle (about one degree), that can be a cut,
/// whatever is beside it.
constexpr float least_step = 1e-3f, least_turn = 0.01f;

/// A camera's way, metres, and turn, as the sine of half its angle, from a key to the next one; 0 beyond the ends.
struct KeyStep {
    float distance = 0, turn = 0;
};

KeyStep step_after(BodyTrack const& track, std::ptrdiff_t key) {
    if (key < 0 || key + 1 >= std::ssize(track.keys)) {
        return {};
    }
    BodyPose const& a = track.keys[static_cast<std::size_t>(key)];
    BodyPose const& b = track.keys[static_cast<std::size_t>(key + 1)];
    float const likeness = std::min(std::abs(glm::dot(a.rotation, b.rotation)), 1.0f);
    return {glm::distance(a.translation, b.translation), std::sqrt(1 - likeness * likeness)};
}

bool is_cut_after(BodyTrack const& track, std::ptrdiff_t key) {
    KeyStep const step = step_after(track, key);
    KeyStep const before = step_after(track, key - 1);
    KeyStep const behind = step_after(track, key + 1);
    return step.distance > least_step + cut_factor * std::max(before.distance, behind.distance) ||
           step.turn > least_turn + cut_factor * std::max(before.turn, behind.turn);
}

} // namespace

Camera camera_at(BodyTrack const& track, SceneTime time, Camera const& like) {
    auto const last = static_cast<double>(std::ssize(track.keys) - 1);
    double const place = time * body_keys_per_second - static_cast<double>(track.first_key);
    SceneTime shown = time;
    if (place > 0 && place < last && is_cut_after(track, static_cast<std::ptrdiff_t>(place))) {
        shown = (std::floor(place) + static_cast<double>(track.first_key)) / body_keys_per_second;
    } else if (place > last && is_cut_after(track, std::ssize(track.keys) - 2)) {
        shown = (last + static_cast<double>(track.first_key)) / body_keys_per_second; // not extrapolated across a cut
    }
    BodyPose const pose = pose_at(track, shown);
    Camera out = like;
    out.position = pose.translation;
    out.orientation = pose.rotation;
    return out;
}

} // namespace framelet
