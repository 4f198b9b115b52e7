// Finds where one framelet shows in the picture of another camera at another time. In: a framelet, display camera and
// time, motions. Out: a patch for each of its layers, a splat for each of its outliers.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/framelet/reprojection.h"
#include "common/held/framelet_pool.h"
#include "common/warp/merging/merged_square.h"
#include "common/warp/warp_patch.h"

namespace framelet {

/// Transforms one framelet after the other and keeps the last transform, since neighbours mostly share view and body.
/// What is not finite or too large for single precision does not show.
class FrameletWarp {
public:
    /// `slot`: that of the cache in its pool.
    FrameletWarp(FrameletCache const& cache, std::size_t slot, SlotRole role, Camera const& display, SceneTime time,
                 BodyMotions const& motions);

    /// Adds the patches and splats of a framelet's `parts`. Bit i of `parts`: layer i; bit `FrameletShape::outlier`:
    /// the outliers.
    void add(CachedFramelet const& framelet, unsigned parts, std::vector<WarpPatch>& patches,
             std::vector<Splat>& splats);
    void add(MergedLayer const& merged, std::vector<WarpPatch>& patches);

    /// The most by which inverse depths may differ from the plane, 1 / metres, so that it is shown less than so many
    /// pixels off, anywhere in the picture. 0 where it stays in its place.
    double inverse_depth_within(double pixels, MergedLayer const& merged);

    /// The display times for which all that was added would be as it is, if the camera stays: nothing carries it then,
    /// nor is it worn by a step more or less. The true span may be longer.
    TimeSpan lasts() const { return lasts_; }

private:
    void turn_to(std::uint32_t view, BodyNumber body, glm::dvec3 const& drift);
    float followed_age(std::uint32_t view, float jerk, double inverse_depth);
    glm::dvec2 middle(HeldLayer const& layer) const;
    void turn_to(std::uint32_t view, HeldLayer const& layer);
    glm::dvec2 low(HeldLayer const& layer) const;
    glm::dvec2 high(HeldLayer const& layer) const;
    void add_layer(std::uint32_t view, HeldLayer const& layer, DecorrelationCode decorrelation, std::uint64_t content,
                   WarpPatch& patch, std::vector<WarpPatch>& patches);
    float worn(std::uint32_t view, DecorrelationCode decorrelation, float spacing, float misplaced, bool still);
    void rate(std::uint32_t view, DecorrelationCode decorrelation, Layer const& layer, WarpPatch& patch);
    /// Pixels by which what is shown at a pixel at depth 1 moves for each 1 / metre.
    float parallax_at(glm::dvec2 pixel) const;
    bool project_still(HeldLayer const& held, WarpPatch& patch) const;
    bool project(HeldLayer const& held, WarpPatch& patch) const;
    void set_maps(PlaneTransform const& plane, WarpPatch& patch) const;
    void add_splats(CachedFramelet const& framelet, WarpPatch& patch, std::vector<Splat>& splats);

    FrameletCache const& cache_;
    std::size_t slot_;
    SlotRole role_;
    Camera const& display_;
    ViewRays display_rays_;
    SceneTime time_;
    TimeSpan valid_; ///< when what was rendered is not out of date
    BodyMotions const& motions_;

    TimeSpan lasts_;

    PixelRect rect_; // of the tile at hand, pixels
    double spacing_ = 1; // of its moving grid, pixels

    bool has_transform_ = false;
    std::uint32_t view_ = 0;
    BodyNumber body_ = static_body;
    glm::dvec3 drift_{0};
    bool is_still_ = false;
    ViewTransform transform_;
    glm::dmat3 stretch_{0}; ///< of the layer at hand
    bool is_lost_ = false; ///< the layer or outlier at hand has drifted for longer than is known
    double parallax_ = 0; ///< the most anywhere in the picture: pixels for each 1 / metre at depth 1
    double lens_ratio_ = 1;
};

} // namespace framelet
