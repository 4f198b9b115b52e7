// The samples of a layer at a few pixels of a row: bilinear interpolation between those that lie on the layer. In: a
// patch, a place in the picture. Out: weighted sums that compete for the pixels.
#pragma once

#include <array>
#include <cstdint>

#include "common/lanes.h"
#include "common/warp_plan.h"

namespace framelet {

/// Pixels of a row that are worked on together: a block's or half of them.
inline constexpr int sampling_lanes = wide_count;
static_assert(FrameletCache::block_side % sampling_lanes == 0);

/// What a patch or a splat shows at each of them: sums of weights and weighted sums of squares of bytes.
struct Candidate {
    WideFloats red, green, blue, weight, inverse_depth;
};

/// The square of a byte, which stands for linear light.
inline float square(std::uint32_t byte) {
    auto const value = static_cast<float>(static_cast<std::int32_t>(byte));
    return value * value;
}

/// The same for some rows of a block.
using CandidateRows = std::array<Candidate, static_cast<std::size_t>(FrameletCache::block_side)>;

/// In `rows` rows, the first pixel of the first of which lies (x, y) from the centre of the box's first pixel. Pixels
/// outside of the box, which are only beside it, get no weight.
void sample_patch(WarpPatch const& patch, float x, float y, int rows, CandidateRows& out);

} // namespace framelet
