// Makes what a viewer that moves its framelets is told of them beside their colours: where their samples lie, and how
// the bodies move that carry them. In: rendered framelets, the scene and its time. Out: shapes and tracks of a batch.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "server/scene/motion/bodies.h"
#include "server/stream/layers/layer_fit.h"

namespace framelet {

/// Seconds of scene time ahead of a batch for which, in the end, its viewer knows where bodies will be: what a slow
/// link or a busy server needs.
inline constexpr SceneTime tracked_ahead_seconds = 1;

/// The feed of one viewer.
class ShapeFeed {
public:
    /// Fits the shapes of those framelets for which `send` (same length) is not 0, in order. `now`: seconds, steady.
    /// Runs in parallel.
    void fit(std::span<Framelet const> rendered, std::span<std::uint8_t const> send, ViewRays const& rays,
             ImagePlane const& plane, double now, std::vector<FrameletShape>& shapes);

    /// Replaces `tracks` by the keys of all bodies until `tracked_ahead_seconds` after `time` that have not been given
    /// out yet, however late this batch comes; by those from `present` or `time` on, whichever is earlier, where `time`
    /// has leapt by seconds or backwards. `present`: the scene time that the viewer shows; it will show `time` later.
    /// `camera_track`: the same of the scene's camera `camera`, the one that the viewer looks through, where it is one
    /// that moves; -1: there is none.
    void track(PoseEvaluator& poses, SceneBodies const& bodies, int camera, SceneTime present, SceneTime time,
               std::vector<BodyTrack>& tracks, std::optional<BodyTrack>& camera_track);

private:
    void follow(Vec3 eye, double now);
    std::int64_t key_behind(SceneTime time) const;

    Vec3 eye_{0};
    double now_ = -std::numeric_limits<double>::infinity(); ///< when the camera was there
    float speed_ = 0; ///< of the camera, metres a second
    float median_depth_ = 0; ///< of what was rendered lately, metres; 0: nothing was
    std::int64_t first_key_ = 0; ///< of the first batch's time
    std::int64_t end_key_ = 0; ///< behind the last one given out
    int camera_ = -1; ///< whose keys these were
    std::vector<std::size_t> sent_; ///< indices of the framelets that are sent
};

} // namespace framelet
