// Fits the few planes that a framelet's samples lie on to their depths and bodies (docs/ALGORITHM.md). In: a framelet,
// how far off a layer may be. Out: its shape. The inverse of the view depth of a plane is affine on the image plane of
// a perspective camera.
#pragma once

#include <span>

#include "common/framelet/framelet.h"
#include "common/framelet/framelet_shape.h"

namespace framelet {

/// Pixels by which a sample may be shown off its position.
inline constexpr float tolerated_pixels = 0.25f;

/// Distance by which a sample may be off its layer, for samples a pixel apart or closer; coarser ones may be off in
/// proportion.
struct LayerTolerance {
    /// 1 / metres. A sample that is off by e moves by e * (translation in metres) * (focal length in pixels) pixels.
    float inverse_depth = 0;
    /// Speed times inverse depth, 1 / seconds, by which what drifts may go otherwise than its layer, for the tenth of a
    /// second that `layer_tolerance` counts with.
    float velocity = 0;
    /// The tolerance that layers are fitted to first, 1 / metres; it stays where it leaves no more than
    /// `most_outliers`. 0: there is none.
    float preferred_inverse_depth = 0;
};

/// The largest number of outliers of a framelet. They cost more than layers, on the wire and in the viewer: where more
/// than these are left, layers are fitted to `wide_tolerances` tolerances instead.
inline constexpr std::size_t most_outliers = 16;
inline constexpr float wide_tolerances = 2;
/// A sample that no plane was found for lies on the nearest layer of its body that it is at most so many tolerances
/// off, in its position and in its velocity.
inline constexpr float isolated_tolerances = 4;

/// The tolerance by which samples are shown off by `tolerated_pixels` while the camera moves so far that what is at
/// `median_depth` (metres, > 0) moves by 20 pixels, and what deforms moves on for a tenth of a second. Preferred: a
/// tenth of a pixel, while the camera moves on as fast as it does for a fifth of a second. `speed`: metres a second.
LayerTolerance layer_tolerance(float median_depth, ViewRays const& rays, float speed);

/// True where the drift of something in a framelet is known for less than so many seconds of scene time.
/// `focal`: focal length of its camera, pixels.
bool drifts_briefly(Framelet const& framelet, ImagePlane const& plane, FrameletShape const& shape, float focal);

/// Median of the finite depths in the framelets, metres, from a part of their samples; 1 where there are none.
float median_depth(std::span<Framelet const> framelets);

/// Fits up to `max_layers` layers; the samples that none of them takes are outliers. The inverse depth of every sample
/// of a layer is within its `error` of the layer, and that within the tolerance (times `wide_tolerances` and
/// `isolated_tolerances`, where these apply), or what single precision resolves. Finite for any depths > 0. The sky is
/// at inverse depth 0. `shape` is overwritten; its memory is used again.
void fit_layers(Framelet const& framelet, ImagePlane const& plane, LayerTolerance const& tolerance,
                FrameletShape& shape);

} // namespace framelet
