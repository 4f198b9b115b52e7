// The interface to a canvas on which blocks of a moved picture are painted if not in memory: on a graphics card. In:
// the blocks that are to be painted, with their patches in order. Out: what showed of them; the picture itself stays on
// the canvas.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "common/image.h"
#include "common/warp/warp_plan.h"

namespace framelet {

/// A block of 16x16 pixels that is to be painted, or of which it is only asked what showed when it was painted.
struct BlockJob {
    int column = 0, row = 0;
    std::uint32_t first_patch = 0, patches = 0; ///< range in the row's `patches`
    bool is_painted = true; ///< is to be painted; else it stays as it is on the canvas
    /// The picture in memory has the block's colours; pixels for which the block lacks inverse depths are infinitely
    /// far, not holes.
    bool is_in_place = false;
};

/// The jobs of one row of blocks.
struct RowJobs {
    std::vector<BlockJob> blocks;
    std::vector<PatchView> patches; ///< of one block after the other, each in the order in which they are painted

    void clear() {
        blocks.clear();
        patches.clear();
    }
};

/// A report of what was painted in a block.
struct BlockReport {
    std::int32_t holes = 0; ///< pixels within the viewport that nothing shows
    std::uint32_t slots = 0; ///< a bit for each slot of which something shows
};

/// All that is to be painted of a picture.
struct CanvasJobs {
    Viewport viewport;
    int columns = 0, rows = 0; ///< of blocks
    std::span<RowJobs const> row_jobs; ///< one for each row
    std::span<WarpPlan> plans; ///< by slot
    Picture const& in_place; ///< colours of blocks that are in place, of the viewport's size
    int flat_contrast = 0; ///< as `filter_pixels` has it
};

/// The graphics card cannot go on painting; the processor can.
struct CanvasError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Paints as `paint_warped_block`, `fill_holes` and `filter_pixels` do, up to rounding: what of several surfaces is the
/// nearest may differ at their outlines, by a pixel at most. All calls from one thread.
class BlockCanvas {
public:
    virtual ~BlockCanvas() = default;

    /// Begins a picture; to be called before all its jobs. True when nothing that was painted before is there any more,
    /// since another owner's pictures were painted meanwhile, or they had another size: then all blocks are to be
    /// painted. `is_new`: the owner is new, though an earlier one may have had its address.
    virtual bool begin(void const* owner, bool is_new, Viewport viewport) = 0;

    /// Paints all jobs, fills holes and filters outlines. `reports` gets one for each job, row by row; what showed of
    /// patches is noted in their `PatchView::shows`. Throws CanvasError where the card cannot do it; what is on the
    /// canvas is lost then.
    virtual void paint(CanvasJobs const& jobs, std::vector<BlockReport>& reports) = 0;
};

} // namespace framelet
