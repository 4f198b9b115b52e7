// Framelets and batches: what the renderer yields, and what travels and is cached.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/camera.h"
#include "common/framelet/body_track.h"
#include "common/framelet/framelet_shape.h"
#include "common/framelet/tile.h"

namespace framelet {

/// Seconds on the scene clock.
using SceneTime = double;

/// 16x16 rendered samples over one tile, in Morton order. Sample (i, j) of the tile lies at the centre of its cell:
/// x = left + (i + 0.5) * spacing, y = top + (j + 0.5) * spacing, pixels.
struct Framelet {
    Tile tile;
    /// Scene-linear radiance, before exposure and tone mapping; finite, >= 0.
    std::array<float, framelet_samples> red, green, blue;
    /// View depth, metres along the camera's forward axis; +infinity where nothing was hit.
    std::array<float, framelet_samples> depth;
    /// The body that carries each sample. Empty: the static body carries them all.
    std::vector<BodyNumber> body;
    /// How samples on what deforms, and shadows that pass over the static body, go on; 0 for all others. Empty: all are
    /// 0.
    std::vector<Drift> drift;
    /// Irradiance by the light cache (luminance / pi) where each sample lies. Empty: there is no cache.
    std::vector<float> light;
    /// Bit i: sample i shows a mirror reflection, which moves otherwise than the surface that it is seen in.
    std::bitset<framelet_samples> reflects;
    bool is_supersampled = false; ///< each sample is the mean of four rays
};

/// The same samples as the viewer needs them: tone-mapped, sRGB-encoded, in Morton order.
struct DisplayFramelet {
    Tile tile;
    std::array<std::uint8_t, framelet_samples> red, green, blue;

    bool operator==(DisplayFramelet const&) const = default;
};

/// The camera that a batch was rendered with, and the viewer's number for it (the newest one the server had).
struct NumberedView {
    std::uint64_t number = 0;
    Camera camera;
    Viewport viewport;
    /// The number of the view since which the viewer holds what it was sent: another viewport begins with nothing. So
    /// does a return to the same one, even if viewer or server has never heard of the viewport in between.
    std::uint64_t held_since = 0;

    bool operator==(NumberedView const&) const = default;
};

/// The largest number of framelets that one batch may carry: 8 Mi samples.
inline constexpr std::size_t max_batch_framelets = 32768;

/// The quantisation parameter (QP) of a framelet: 0 is without loss; above that quantisation steps grow with the
/// number.
inline constexpr std::uint8_t lossless_qp = 0;
inline constexpr std::uint8_t coarsest_qp = 127;

/// Framelets of one camera and one scene time.
struct Batch {
    std::uint64_t number = 0; ///< counts up by one within a session, from 1
    NumberedView view;
    SceneTime scene_time = 0;
    /// The scene time before which its framelets are not to be shown, since the scene jumps then. In the past: they are
    /// shown at once.
    SceneTime shown_from = 0;
    bool outdates = false; ///< what was rendered for times before `shown_from` looks otherwise from then on
    std::vector<DisplayFramelet> framelets;
    std::vector<std::uint8_t> qp{}; ///< of each framelet, 0..coarsest_qp; empty: all are exact
    /// A shape for each framelet; none at all where the viewer has no use for them.
    std::vector<FrameletShape> shapes{};
    /// Tracks of the bodies of the shapes: what the viewer has not been told yet.
    std::vector<BodyTrack> tracks{};
    /// Track of the scene's camera through which the viewer looks: what it has not been told yet. Its body is
    /// `camera_body` of that camera.
    std::optional<BodyTrack> camera_track{};

    bool operator==(Batch const&) const = default;
};

} // namespace framelet
