// Where everything that is held shows in the picture of another camera at another time: a patch for each layer, a splat
// for each loose sample, and for each block of the picture the patches that may touch it. In: cache, display camera and
// time, motions. Out: the plan, from which every block is painted on its own.
#pragma once

#include <cstdint>
#include <vector>

#include "common/body_motion.h"
#include "common/fine_merge.h"
#include "common/framelet_cache.h"
#include "common/framelet_warp.h"
#include "common/warp_patch.h"

namespace framelet {

class WarpPlan {
public:
    /// As many patches are kept for a block, on the average. Where a camera goes so near that there would be more, the
    /// newest ones are.
    static constexpr std::size_t most_patches_per_block = 256;

    /// Replaces the plan; `cache` is always the same one. Runs in parallel; allocates only where more is held than ever
    /// before.
    void make(FrameletCache const& cache, Camera const& display, SceneTime display_time, BodyMotions const& motions);

    /// The same for the cache's spares.
    void make_spares(FrameletCache const& cache, Camera const& display, SceneTime display_time,
                     BodyMotions const& motions);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Fills `patches` with what may touch a block: newest batch first, then in an order that depends on tiles and
    /// layers only.
    void block(std::size_t index, std::vector<PatchView>& patches) const;
    /// The blocks' numbers of patches, all together.
    std::size_t entry_count() const { return entries_.size(); }

private:
    struct Chunk {
        std::vector<WarpPatch> patches;
        std::vector<Splat> splats;
    };

    /// Below one square of 2x2 blocks: framelets of one sample a pixel, then finer ones.
    using Square = std::array<FineSquare, finest_levels + 1>;

    void set_size(Viewport viewport);
    void merge_square(FrameletCache const& cache, Tile tile, Square& square, FrameletWarp& warp,
                      std::vector<WarpPatch>& patches);
    void set_merged(Tile over, int levels, unsigned flags);
    bool is_block(Tile tile) const {
        return static_cast<int>(tile.column()) < columns_ && static_cast<int>(tile.row()) < rows_;
    }
    std::size_t index_of(Tile block) const {
        return static_cast<std::size_t>(block.row()) * static_cast<std::size_t>(columns_) + block.column();
    }
    bool is_merged(ImagePlane const& plane, Tile tile) const;
    void limit_entries();
    void make_bins();

    int columns_ = 0, rows_ = 0;
    std::vector<Square> squares_; ///< in rows; none where a block is all there is
    std::vector<Chunk> chunks_; ///< of squares of 2x2 blocks, then of slots
    /// By block: bit 0 where the framelets one level finer than pixels are merged, bit 1 + i where those two levels
    /// finer are in quarter i, bit 5 where that of one sample a pixel is.
    std::vector<std::uint8_t> merged_;
    std::vector<std::uint32_t> first_entry_; ///< by block; one more at the end
    std::vector<std::uint32_t> next_entry_;
    std::vector<std::uint32_t> entries_; ///< chunk * patches_per_chunk + patch
};

} // namespace framelet
