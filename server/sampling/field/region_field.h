// The region field: what the server knows of every region of one viewer's picture, and what the viewer holds there: a
// field over the image plane in Morton order. In: time and camera as they go on, and what was rendered. Out: the error
// that is shown.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "server/render/probe.h"
#include "server/sampling/field/density_tiling.h"
#include "server/sampling/model/region_model.h"

namespace framelet {

/// A time before any other, seconds.
inline constexpr double never = -std::numeric_limits<double>::infinity();

inline constexpr std::size_t probes_per_region = 16;

/// Samples that have been taken to be rendered and are not learnt yet.
struct TakenSamples {
    int level = -1; ///< -1: nothing
    float drift = 0; ///< since they were taken
    double when = never; ///< when they were taken, seconds
};

struct Region {
    RegionModel model = unknown_region();
    int level = -1; ///< level of the samples that the viewer holds; -1: none
    float drift = 0; ///< drift since those were rendered
    double rendered = never; ///< when those were rendered, seconds
    bool supersampled = false; ///< those are means of four rays each
    float left = 0; ///< mean squared error that the finest samples leave, by their last rendering alone
    TakenSamples taken;
    double changed = never; ///< when it was last seen to be different, seconds
    /// The time at which it was last rendered with nothing to compare with, and might have changed, seconds.
    double suspected = never;
    double checked = never; ///< when it was last rendered or probed, seconds
    double asked = never; ///< when it was last taken to be rendered or probed, learnt or not, seconds
    bool settled = true; ///< false from a change that was seen until two renderings are the same
    double refreshed = never; ///< when all its pixels were last rendered, seconds
    float inverse_depth = 0; ///< mean, 1/metres
    float arriving = 0; ///< the farthest way, pixels, by which the camera's last step brought something here
    float speed = 0; ///< of the camera's motion here, pixels a second, when `model.motion` was learnt
    std::array<Probe, probes_per_region> probes{};
    std::size_t probe_count = 0;
    std::array<float, probes_per_region> seen{}; ///< luma of the probes when they were last rendered
};

class RegionField {
public:
    RegionField() : RegionField(ImagePlane()) {}
    explicit RegionField(ImagePlane plane);

    ImagePlane const& plane() const { return plane_; }
    int depth() const { return depth_; }
    /// Levels that tiles of this plane can have: [least_level(), sampling_levels).
    int least_level() const { return plane_.min_depth() - plane_.pixel_depth() + pixel_level; }
    /// Level of tiles of a quadtree depth, and the depth of tiles of a level.
    int level_of(int tile_depth) const { return tile_depth - plane_.pixel_depth() + pixel_level; }
    int depth_of(int level) const { return level + plane_.pixel_depth() - pixel_level; }

    /// Morton indices of the regions of which something is in the viewport.
    std::span<std::uint32_t const> visible() const { return visible_; }
    Region& operator[](std::uint32_t index) { return regions_[index]; }
    Region const& operator[](std::uint32_t index) const { return regions_[index]; }
    std::size_t size() const { return regions_.size(); }
    /// Pixels along a side of a region.
    int region_side() const { return plane_.side() >> depth_; }
    /// Number of pixels of a region that lie in the viewport.
    float pixels_of(std::uint32_t index) const { return pixels_[index]; }
    /// The square of a region, pixels, also beyond the viewport.
    PixelRect rect_of(std::uint32_t index) const;
    /// The patch of one region alone, with tiles of a depth that is no less than the field's.
    Patch patch_of(std::uint32_t index, int tile_depth) const { return {{(1u << (2 * depth_)) + index}, tile_depth}; }

    /// Indices of the regions under a node.
    struct Range {
        std::uint32_t first = 0, last = 0;

        std::size_t size() const { return last - first; }
    };
    Range range_of(Tile node) const;

private:
    ImagePlane plane_;
    int depth_;
    std::vector<Region> regions_;
    std::vector<float> pixels_;
    std::vector<std::uint32_t> visible_;
};

/// The error that the viewer sees at this region once what was taken has been rendered and `more` drift has been added.
float shown_error(Region const& region, float more);
/// Error of a region of which the viewer has nothing.
inline constexpr float bare_error = 0.25f;

/// Lets time go on by `seconds` while the camera moves from one view to the other. `moving`: things of the scene may
/// move as well. A region drifts as it was found to, more where the camera has become faster, less where slower: by as
/// much as what it shows is carried away, or as what comes there instead.
void drift_on(RegionField& field, ViewRays const& from, ViewRays const& to, bool moving, float seconds);

/// Notes that a patch has been taken to be rendered, with so many rays a sample.
void take(RegionField& field, Patch const& patch, double now, int rays_per_sample);
/// Clears what was taken of these patches at `when`; what was taken again later stays taken.
void release(RegionField& field, std::span<Patch const> patches, double when);
/// Declares that nothing that is held is true any more (a cut, another exposure).
void invalidate(RegionField& field);

} // namespace framelet
