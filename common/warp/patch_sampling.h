// Interpolates the samples of a layer at a few pixels of some rows, bilinearly between those that lie on the layer. In:
// a patch, pixels of the picture. Out: weighted sums that compete for the pixels.
#pragma once

#include <array>
#include <cstdint>

#include "common/simd/lanes.h"
#include "common/warp/warp_patch.h"

namespace framelet {

/// What a patch or a splat shows at each of some pixels, as `wide_column` and `wide_row` have them: sums of weights and
/// weighted sums of squares of bytes. It is firm, and hides what lies behind it, where the nearest sample is its own.
struct Candidate {
    WideFloats red, green, blue, weight, inverse_depth;
    WideInts is_firm;
    WideInts ends; ///< the surface ends before here: the nearest sample is farther. Only of patches with ends
};

/// The square of a byte, which stands for linear light.
inline float square(std::uint32_t byte) {
    auto const value = static_cast<float>(static_cast<std::int32_t>(byte));
    return value * value;
}

/// Candidates for all rows of a block, in groups of `wide_rows` rows, one below the other.
using CandidateColumn = std::array<Candidate, static_cast<std::size_t>(FrameletCache::block_side / wide_rows)>;
static_assert(FrameletCache::block_side % wide_columns == 0 && FrameletCache::block_side % wide_rows == 0);

/// Samples a patch for the first `count` candidates of a column, of which the first pixel of the first one lies (x, y)
/// from the centre of the box's first pixel. Firm is what lies in the cell of an own sample, half a sample around it:
/// an outline is midway between the last sample that hit and the first that missed, where it is on the average, and of
/// framelets that meet one is firm. Pixels outside of the box get no weight: those beside it, and where lanes have two
/// rows those of the row above its first or below its last.
void sample_patch(WarpPatch const& patch, float x, float y, int count, CandidateColumn& out);

/// False when all these pixels would get no weight, since none of the patch's samples is near; looks at `occupied`.
bool may_show(WarpPatch const& patch, float x, float y, int count);

} // namespace framelet
