// Means of what lies around holes, far away: of whole blocks of a moved picture and of ever larger squares of blocks.
// In: blocks as painted. Out: a mean for every block, also where nothing shows.
#pragma once

#include <span>
#include <vector>

#include "common/picture/far_grid.h"
#include "common/warp/warp_block.h"

namespace framelet {

/// The mean for a block as painted. (Where it has no holes, of every sixteenth pixel.)
FarMean far_mean(WarpedBlock const& block);

/// Means of a picture's blocks and of ever larger squares of blocks; among those no depth is preferred.
class FarMeans {
public:
    /// `columns` x `rows` blocks in rows. Squares of which nothing shows get their colour from larger ones.
    void make(std::span<FarMean const> blocks, int columns, int rows);
    /// The mean for a block, whose coordinates are clamped to the picture; `FarMean::nothing` where nothing shows
    /// anywhere.
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

} // namespace framelet
