// Tables of numbers by which the shader that paints knows a plan. In: the jobs of a picture, where samples are. Out:
// tables of 32 bits a number, floats as their bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "client/gpu/sample_atlas.h"
#include "common/picture/block_canvas.h"

namespace framelet {

/// Kept from picture to picture for its memory; allocates only where more is painted than ever before.
class PatchTable {
public:
    /// Number of bits that report which patches of a block showed: the first patches have one each; the last bit is
    /// also that of all patches that follow.
    static constexpr std::uint32_t most_claims = 128;
    /// Number of a block's first patches that can be leaders of which the group's pixels are counted.
    static constexpr std::uint32_t most_counted = 64;

    /// Six texels of four numbers for each patch: inverse depth, its slopes, tolerance; the nine numbers of its maps,
    /// then where its samples are in the atlas, their side, number and flags, and one that is unused; two texels of
    /// `ends_before`.
    std::vector<std::uint32_t> patches;
    /// One texel of four numbers for each patch of each block: number of the patch, and from bit 24 on the first patch
    /// of its group in the block; its box there, four bits each of first column, first row, last column, last row, and
    /// from bit 16 on whether it is of outliers; its group; the corner of its box in the picture or, of outliers, where
    /// the lists of its splats begin among those of the block's row.
    std::vector<std::uint32_t> entries;
    /// Lists for each patch of outliers of each block: where the list of splats of each 4x4 pixels begins, in rows, and
    /// where the last one ends, counted from here; then these lists, of numbers among the splats of the block's row.
    std::vector<std::uint32_t> lists;
    /// Two texels of four numbers for each splat: x, y (pixels of the picture), inverse depth, spacing (pixels);
    /// colour, its block among `blocks`, number of its patch there, and one that is unused.
    std::vector<std::uint32_t> splats;
    /// Two texels of four numbers for each block that is painted: column and row, first entry, number of entries and
    /// from bit 16 on flags (1: in place), where its row's lists begin; where its row's splats begin.
    std::vector<std::uint32_t> blocks;

    std::size_t block_count() const { return block_count_; }
    std::size_t splat_count() const { return splat_count_; }

    /// Replaces all tables, and brings the atlas up to date with the samples that they refer to.
    void make(CanvasJobs const& jobs, SampleAtlas& atlas);

private:
    static constexpr std::size_t words_of_block = 8;
    static constexpr std::size_t words_of_splat = 8;
    static constexpr std::size_t words_of_patch = 24;
    static constexpr std::size_t words_of_entry = 4;

    struct Row {
        std::vector<std::uint32_t> entries, lists, splats, blocks;
        std::vector<std::int32_t> groups; ///< scratch: groups of a block's patches
        std::vector<std::uint32_t> leaders; ///< scratch: the first patch of each of these
    };

    void find_used(CanvasJobs const& jobs);
    void find_small(CanvasJobs const& jobs);
    void write_square(CanvasJobs const& jobs, SampleAtlas const& atlas, std::size_t index);
    void write_row(CanvasJobs const& jobs, RowJobs const& from, Row& row) const;
    static std::uint32_t add_splats(BlockJob const& job, PatchView const& view, std::uint32_t number, Row& row);
    void join(std::span<Row const> rows);

    std::vector<std::vector<std::uint32_t>> first_patch_; ///< by slot and square
    std::vector<SampleAtlas::Grid> grids_; ///< of squares that are used
    std::vector<std::uint32_t> first_small_; ///< for each of these grids: number of its first small grid
    std::vector<SampleAtlas::SmallGrid> small_grids_;
    std::vector<Row> rows_;
    std::size_t block_count_ = 0, splat_count_ = 0;
};

/// The leader of a patch: the first patch of its group in the block. Called for each patch of a block in order, with
/// `groups` and `leaders` empty at first; at most `PatchTable::most_claims` - 1.
std::uint32_t leader_of(std::int32_t group, std::uint32_t index, std::vector<std::int32_t>& groups,
                        std::vector<std::uint32_t>& leaders);

} // namespace framelet
