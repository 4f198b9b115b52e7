// Fills what no sample shows from what lies around it (pull-push, 000 section 3.3), from the farther side: what a
// moving edge uncovers belongs to the background. In: picture, inverse depth with holes, a mean for each block. Out:
// the holes' pixels. Blocks are independent of each other once their means are there, and equal what the whole picture
// would give.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/image.h"
#include "common/warp_block.h"

namespace framelet {

/// Mean of the farthest of several pixels: squares of sRGB-encoded values as in `WarpedBlock`.
struct FarMean {
    static constexpr float nothing = 1e30f;

    float red = 0, green = 0, blue = 0;
    float inverse_depth = nothing; ///< `nothing` where there is nothing to take a mean of

    bool operator==(FarMean const&) const = default;
};

/// The mean for a block as painted. (Where it has no holes, of every sixteenth pixel.)
FarMean far_mean(WarpedBlock const& block);

/// Means of a picture's blocks and of ever larger squares of blocks; among those no depth is preferred.
class FarMeans {
public:
    /// `columns` x `rows` blocks in rows. Squares of which nothing shows get their colour from larger ones.
    void make(std::span<FarMean const> blocks, int columns, int rows);
    /// Block coordinates are clamped to the picture. Nothing shows anywhere: `nothing`.
    FarMean const& at(int column, int row) const;

private:
    struct Level {
        int columns = 0, rows = 0;
        std::vector<FarMean> means;

        FarMean const& at(int column, int row) const;
    };
    void pull(Level const& fine, Level& coarse) const;
    void push(Level const& coarse, Level& fine) const;

    std::vector<Level> levels_;
};

/// Writes the holes among a block's pixels: those whose `inverse_depth` (a plane of the picture's size) is
/// `hole_depth`. Nothing shows anywhere: `uncovered_light`.
void fill_holes(FarMeans const& means, std::span<float const> inverse_depth, int column, int row, Picture& picture);

} // namespace framelet
