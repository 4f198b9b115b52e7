// Makes pixels of held framelets ([Stephens 2011] section 4.2): tent filter where samples are coarser than pixels, box
// filter where they are finer, both in linear light; the newest batch wins. In: cache and what changed. Out: those
// pixels.
#pragma once

#include <span>

#include "common/held/framelet_cache.h"
#include "common/image.h"

namespace framelet {

/// Linear light of a pixel that nothing covers yet: dark enough not to glare, light enough not to pass for black.
inline constexpr float uncovered_light = 0.05f;

/// Recomputes the pixels of `changed` (as `FrameletCache::take_changed` gives them; grown to whole blocks, clipped to
/// the viewport) in `picture`, which has the viewport's size. Pixels are a pure function of what the cache holds:
/// recomputing what changed leaves the same bytes as recomputing everything.
///
/// Sample spacing s > 1 pixel: bilinear interpolation between samples (a tent of radius s). Beyond its border a
/// framelet takes the samples of a neighbour of the same moment, of the same depth or up to two levels finer (their
/// mean); where there is none it repeats its own. s = 1: the sample. s < 1: the mean of the pixel's samples.
///
/// Runs in parallel over rows of blocks.
void reconstruct(FrameletCache const& cache, std::span<PixelRect const> changed, Picture& picture);

/// The same for the block of 16x16 pixels in one column and row.
void reconstruct_block(FrameletCache const& cache, int column, int row, Picture& picture);

/// The same for the whole viewport.
void reconstruct_all(FrameletCache const& cache, Picture& picture);

} // namespace framelet
