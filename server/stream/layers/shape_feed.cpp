#include "server/stream/layers/shape_feed.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/marked_indices.h"

namespace framelet {
namespace {

/// The largest number of keys that are made up for after a pause, without which the viewer could not move what it has
/// from before; where more are missing the clock has leapt.
constexpr std::int64_t most_missed_keys = 5 * body_keys_per_second;
/// Fewest keys that are given out at a time: a track costs bytes of its own.
constexpr std::int64_t least_keys = body_keys_per_second / 10;
/// Seconds ahead that are known at first, and how many more for each second: the first picture does not wait for keys
/// that hardly anybody will need.
constexpr SceneTime first_ahead_seconds = 0.3, ahead_growth = 0.5;

} // namespace

/// Follows the speed of the camera, over a tenth of a second since cameras come more rarely than batches.
void ShapeFeed::follow(Vec3 eye, double now) {
    constexpr double seconds = 0.1;
    double const elapsed = now - now_;
    if (elapsed > 0 && std::isfinite(elapsed)) {
        float const speed = glm::distance(eye, eye_) / static_cast<float>(elapsed);
        speed_ += static_cast<float>(1 - std::exp(-elapsed / seconds)) * (speed - speed_);
    }
    eye_ = eye;
    now_ = now;
}

void ShapeFeed::fit(std::span<Framelet const> rendered, std::span<std::uint8_t const> send, ViewRays const& rays,
                    ImagePlane const& plane, double now, std::vector<FrameletShape>& shapes) {
    FRAMELET_CHECK(rendered.size() == send.size());
    list_marked(send, sent_);
    shapes.resize(sent_.size());
    if (sent_.empty()) {
        return;
    }
    follow(rays.origin, now);
    // A small batch may lie in a corner of the picture.
    constexpr float weight = 0.1f;
    float const found = median_depth(rendered);
    median_depth_ = median_depth_ > 0 ? median_depth_ + weight * (found - median_depth_) : found;
    LayerTolerance const tolerance = layer_tolerance(median_depth_, rays, speed_);
    float const focal = 1 / glm::length(rays.direction_dx);
    tbb::parallel_for(std::size_t{0}, sent_.size(), [&](std::size_t i) {
        Framelet const& framelet = rendered[sent_[i]];
        fit_layers(framelet, plane, tolerance, shapes[i]);
        shapes[i].is_brief = drifts_briefly(framelet, plane, shapes[i], focal);
    });
}

void ShapeFeed::track(PoseEvaluator& poses, SceneBodies const& bodies, int camera, SceneTime present, SceneTime time,
                      std::vector<BodyTrack>& tracks, std::optional<BodyTrack>& camera_track) {
    tracks.clear();
    camera_track.reset();
    if (!bodies.any_moves() && camera < 0) {
        return;
    }
    auto const key = static_cast<std::int64_t>(std::floor(time * body_keys_per_second));
    auto const most_keys = static_cast<std::int64_t>(max_batch_keys / bodies.frames.size());
    bool const goes_on = camera == camera_ && end_key_ > first_key_ && key >= first_key_ &&
                         key <= end_key_ + most_missed_keys && key_behind(time) <= end_key_ + most_keys;
    if (!goes_on) {
        auto const shown = static_cast<std::int64_t>(std::floor(std::min(present, time) * body_keys_per_second));
        first_key_ = key;
        end_key_ = std::max(shown, key_behind(time) - most_keys);
        camera_ = camera;
    }
    std::int64_t const end = key_behind(time);
    if (end - end_key_ >= (goes_on ? least_keys : 1)) {
        auto const count = static_cast<std::size_t>(end - end_key_);
        tracks = body_tracks(poses, bodies, end_key_, count);
        if (camera >= 0) {
            camera_track = scene_camera_track(poses, camera, end_key_, count);
        }
        end_key_ = end;
    }
}

/// The key behind all that is given out with the batch of `time`.
std::int64_t ShapeFeed::key_behind(SceneTime time) const {
    SceneTime const known = time - static_cast<double>(first_key_) / body_keys_per_second;
    SceneTime const ahead = std::min(first_ahead_seconds + ahead_growth * known, tracked_ahead_seconds);
    return static_cast<std::int64_t>(std::ceil((time + ahead) * body_keys_per_second)) + 1;
}

} // namespace framelet
