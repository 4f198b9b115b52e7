// Tiling from density: the quadtree cut in which every tile is worth about one framelet ([Stephens 2011]
// section 4.1.6). In: samples per pixel over a field of elements in Morton order. Out: patches, which are parts of a
// tiling, and tiles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/tile.h"

namespace framelet {

/// The tiles of one depth in one quadtree node.
struct Patch {
    Tile node;
    int depth = 0; ///< depth of its tiles, >= node.depth()

    bool operator==(Patch const&) const = default;
};

/// Number of tiles of a patch, including those outside the viewport.
constexpr double tile_count(Patch const& patch) {
    return static_cast<double>(std::uint64_t{1} << (2 * (patch.depth - patch.node.depth())));
}

/// The largest quadtree depth of a field's elements (regions), so that what is computed for each of them does not grow
/// with the picture.
inline constexpr int most_field_depth = 6;
/// Quadtree depth of a field's elements: the depth at which tiles have one sample a pixel, at most `most_field_depth`.
inline int field_depth(ImagePlane const& plane) {
    return plane.pixel_depth() < most_field_depth ? plane.pixel_depth() : most_field_depth;
}

/// Scratch of make_density_patches; kept between calls so that they allocate nothing.
struct TilingScratch {
    std::vector<std::uint64_t> sums;
};

/// Replaces `patches` by disjoint patches that cover the viewport, along the Morton curve. `samples_per_pixel`: 4^depth
/// finite values >= 0 in Morton order; elements outside the viewport are not looked at. A node is one tile once the
/// integral of density over it is at most two framelets (the middle, by ratio, between a framelet and its four
/// children), within the plane's limits of depth. Elements finer than that stay one patch of equal tiles. Integrals are
/// differences of prefix sums in whole steps of 1/256 sample, so that the cut does not depend on the order of
/// summation.
void make_density_patches(ImagePlane const& plane, std::span<float const> samples_per_pixel, int depth,
                          TilingScratch& scratch, std::vector<Patch>& patches);

/// Appends the patch's visible tiles, along the Morton curve.
void append_tiles(ImagePlane const& plane, Patch const& patch, std::vector<Tile>& tiles);

} // namespace framelet
