#include "server/layers/shape_feed.h"

#include <cmath>

#include <glm/geometric.hpp>

#include <tbb/parallel_for.h>

#include "common/error.h"

namespace framelet {

/// Cameras come more rarely than batches: what counts is their speed over a tenth of a second.
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
    sent_.clear();
    for (std::size_t i = 0; i < send.size(); ++i) {
        if (send[i] != 0) {
            sent_.push_back(i);
        }
    }
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
    tbb::parallel_for(std::size_t{0}, sent_.size(),
                      [&](std::size_t i) { fit_layers(rendered[sent_[i]], plane, tolerance, shapes[i]); });
}

void ShapeFeed::track(Scene const& scene, std::span<Index const> clips, SceneBodies const& bodies, SceneTime time,
                      std::vector<BodyTrack>& tracks) {
    tracks.clear();
    if (!bodies.any_moves()) {
        return;
    }
    auto const key = static_cast<std::int64_t>(std::floor(time * body_keys_per_second));
    auto const end = static_cast<std::int64_t>(std::ceil((time + tracked_ahead_seconds) * body_keys_per_second)) + 1;
    bool const goes_on = key >= first_key_ && key <= end_key_;
    if (!goes_on) {
        first_key_ = end_key_ = key;
    }
    if (end_key_ < end) {
        tracks = body_tracks(scene, clips, bodies, end_key_, static_cast<std::size_t>(end - end_key_));
        end_key_ = end;
    }
}

} // namespace framelet
