// What the shader that paints reads of a plan, as tables of numbers. In: the jobs of a picture, where samples are. Out:
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
    /// As many of a block's patches have a bit of their own in what is reported; the last one has all that follow too.
    static constexpr std::uint32_t most_claims = 128;
    /// Patches from this one on are no leaders that are counted.
    static constexpr std::uint32_t most_counted = 64;

    /// Six texels of four for each patch: inverse depth, its slopes, tolerance; the nine numbers of its maps, then
    /// where its samples are in the atlas, their side, number and flags, and one that is unused; two texels of
    /// `ends_before`.
    std::vector<std::uint32_t> patches;
    /// One of four for each patch of each block: the patch, and from bit 24 on the first of its group in the block; its
    /// box there, four bits each of first column, first row, last column, last row, and whether it is of outliers;
    /// group; the corner of its box in the picture, or where the lists of its splats begin among those of the block's
    /// row.
    std::vector<std::uint32_t> entries;
    /// For each patch of outliers of each block where the splats begin of each 4x4 pixels, in rows, and where the last
    /// end; then these, numbers among the block's row's.
    std::vector<std::uint32_t> lists;
    /// Two texels of four: x, y, inverse depth, spacing; colour, its block among `blocks`, number of its patch there.
    std::vector<std::uint32_t> splats;
    /// Two texels of four for each block that is painted: column and row, first entry, number of them and from bit 16
    /// on flags (1: in place), where its row's lists begin; where its row's splats begin.
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
        std::vector<std::int32_t> groups; ///< scratch: of a block
        std::vector<std::uint32_t> leaders; ///< scratch: of these
    };

    void find_used(CanvasJobs const& jobs);
    void find_small(CanvasJobs const& jobs);
    void write_square(CanvasJobs const& jobs, SampleAtlas const& atlas, std::size_t index);
    void write_row(CanvasJobs const& jobs, RowJobs const& from, Row& row) const;
    static std::uint32_t add_splats(BlockJob const& job, PatchView const& view, std::uint32_t number, Row& row);
    void join(std::span<Row const> rows);

    std::vector<std::vector<std::uint32_t>> first_patch_; ///< by slot and square
    std::vector<SampleAtlas::Grid> grids_; ///< of squares that are used
    std::vector<std::uint32_t> first_small_; ///< by these: number of its first small grid
    std::vector<SampleAtlas::SmallGrid> small_grids_;
    std::vector<Row> rows_;
    std::size_t block_count_ = 0, splat_count_ = 0;
};

/// The first patch of a block of the same group as each, in order; at most `PatchTable::most_claims` - 1.
std::uint32_t leader_of(std::int32_t group, std::uint32_t index, std::vector<std::int32_t>& groups,
                        std::vector<std::uint32_t>& leaders);

} // namespace framelet
