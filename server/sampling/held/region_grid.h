// Regions: squares of the image plane, in Morton order, by which work is planned, and what the viewer holds in each.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "server/render/rays_per_sample.h"
#include "server/sampling/held/patch.h"
#include "server/sampling/held/sampling_level.h"

namespace framelet {

/// A time before any other, seconds.
inline constexpr double never = -std::numeric_limits<double>::infinity();

/// The largest quadtree depth of regions, so that what is computed for each of them does not grow with the picture.
inline constexpr int most_region_depth = 6;
/// Quadtree depth of regions: the depth at which tiles have one sample a pixel, at most `most_region_depth`.
inline int region_depth(ImagePlane const& plane) {
    return plane.pixel_depth() < most_region_depth ? plane.pixel_depth() : most_region_depth;
}

/// Samples that have been taken to be rendered and are not learnt yet.
struct TakenSamples {
    int level = -1; ///< that they show; -1: nothing
    double when = never; ///< when they were taken, seconds
};

/// What a viewer holds at a region.
struct Region {
    int level = -1; ///< of the samples that came last; -1: none
    int rays_per_sample = single_ray; ///< of those
    double rendered = never; ///< when those were planned, seconds
    float left = 0; ///< mean squared error that samples of a picture at rest leave, by their last rendering alone
    TakenSamples taken;
};

/// Level that samples of this level show: means of several rays are as good as samples of the next finer level.
constexpr int shown_level(int level, int rays_per_sample) {
    return rays_per_sample > single_ray && level < finest_level ? level + 1 : level;
}

class RegionGrid {
public:
    RegionGrid() : RegionGrid(ImagePlane()) {}
    explicit RegionGrid(ImagePlane plane);

    ImagePlane const& plane() const { return plane_; }
    int depth() const { return depth_; }
    /// Levels that tiles of this plane can have: [least_level(), sampling_levels).
    int least_level() const { return level_of(plane_.min_depth()); }
    /// Level of tiles of a quadtree depth, and the depth of tiles of a level.
    int level_of(int tile_depth) const { return tile_depth - plane_.pixel_depth() + pixel_level; }
    int depth_of(int level) const { return level + plane_.pixel_depth() - pixel_level; }

    /// Morton indices of the regions of which something is in the viewport.
    std::span<std::uint32_t const> visible() const { return visible_; }
    Region& operator[](std::uint32_t index) { return regions_[index]; }
    Region const& operator[](std::uint32_t index) const { return regions_[index]; }
    /// Regions of which a patch is a part, or which are parts of it.
    std::span<Region> operator[](Patch const& patch);
    std::size_t size() const { return regions_.size(); }
    /// Number of pixels of a region that lie in the viewport.
    float pixels_of(std::uint32_t index) const { return pixels_[index]; }
    /// The square of a region, pixels, also beyond the viewport.
    PixelRect rect_of(std::uint32_t index) const { return plane_.tile_rect(node_of(index)); }
    /// The patch of one region alone, with tiles of a depth that is no less than that of regions.
    Patch patch_of(std::uint32_t index, int tile_depth) const { return {node_of(index), tile_depth}; }
    /// Index of the first region under a node.
    std::uint32_t first_under(Tile node) const { return node.index() << (2 * (depth_ - node.depth())); }

    /// Notes that a patch has been taken to be rendered.
    void take(Patch const& patch, double now, int rays_per_sample);
    /// Notes that what was taken at `when` has come to the viewer; what was taken again since stays taken.
    void note_held(Patch const& patch, double when, int rays_per_sample);

private:
    Tile node_of(std::uint32_t index) const { return {(1u << (2 * depth_)) + index}; }

    ImagePlane plane_;
    int depth_;
    std::vector<Region> regions_;
    std::vector<float> pixels_;
    std::vector<std::uint32_t> visible_;
};

} // namespace framelet
