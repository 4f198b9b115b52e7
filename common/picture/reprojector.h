// Makes the picture of any camera at any scene time from what is held ([Nehab 2006], [Yang 2011]; one homography a
// layer, docs/ALGORITHM.md). In: cache, what changed in it, camera, time, motions of bodies. Out: the picture, and
// which parts of it changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_pool.h"
#include "common/image.h"
#include "common/picture/block_canvas.h"
#include "common/picture/hole_fill.h"
#include "common/picture/pixel_filter.h"
#include "common/warp/warp_plan.h"

namespace framelet {

/// Steps besides moving. The evaluation leaves some out, to see what each is worth.
struct ReprojectorParts {
    int flat_contrast = framelet::flat_contrast; ///< as `filter_pixels` has it; 255: no outline is filtered
    bool keeps_cuts = true; ///< where nearly nothing would show, all stays where it was rendered
    bool operator==(ReprojectorParts const&) const = default;
};

/// Moves pictures. Keeps what it needs to know next time which blocks stay as they are; what it shows is a function of
/// its arguments only, whatever it showed before and however many threads there are.
class Reprojector {
public:
    explicit Reprojector(ReprojectorParts const& parts = {}) : parts_(parts) {}

    /// Writes to `picture`, which has the viewport's size and, from the second call on, holds what the last one wrote.
    /// `changed` is what `take_changed` of the pool's newest cache gives: all that changed since the last call.
    /// `repainted` becomes the rectangles that may differ from the last call's, ordered as `take_changed` orders them.
    ///
    /// The nearest of all that is held shows, and of several samples of one surface those with the least
    /// `worn_spacing`. Where the base of the newest camera covers the picture with a sample a pixel or more, was
    /// taken with this camera, nothing in it has moved since, and nothing else that its camera saw moving is held, the
    /// picture is `reconstruct` of it, byte by byte; so is every block for which that holds while others move. Samples
    /// of or for an orthographic camera stay on their pixels. All stays on its pixels where the camera has cut: where
    /// nearly nothing of what is held would show in the new view. Only blocks whose samples or their places differ from
    /// the last call's are painted.
    ///
    /// With a canvas, a picture in which something has to be moved is painted there, and any other one
    /// (`reconstruct`'s, or after a cut) in `picture`: `is_on_canvas` says where it is, which may change from one call
    /// to the next. Throws what the canvas throws; the next call paints all of the picture then.
    void show(FrameletPool const& pool, std::span<PixelRect const> changed, Camera const& camera, SceneTime scene_time,
              BodyMotions const& motions, Picture& picture, std::vector<PixelRect>& repainted,
              BlockCanvas* canvas = nullptr);

    /// True when the last picture was `reconstruct`'s as a whole.
    bool is_exact() const { return is_exact_; }
    /// True when the last picture is not in memory.
    bool is_on_canvas() const { return is_on_canvas_; }
    /// A plane of the picture's size, 1 / metres; `hole_depth` where the colour is only filled in. Not kept up while
    /// the picture is exact or on a canvas.
    std::span<float const> inverse_depth() const { return inverse_depth_; }
    /// Number of blocks of the last picture in which something of a slot shows, by slot of the pool.
    std::span<std::uint32_t const> shown_blocks() const { return shown_blocks_; }
    /// The tiles of one slot of which something shows in the last picture, if that is known: false where the slot had
    /// not been tried by then or the picture was exact. Some come more than once.
    bool add_shown(std::size_t slot, std::vector<Tile>& tiles) const;
    /// Share of the last picture's pixels that no sample shows, [0, 1]; 0 where it is exact.
    double hole_share() const { return hole_share_; }

private:
    struct BlockState {
        std::uint64_t signature = 0;
        std::int32_t holes = 0;
        std::uint32_t slots = 0; ///< a bit for each slot of which something shows
    };

    bool is_in_place(FrameletPool const& pool, Camera const& camera, SceneTime scene_time) const;
    void show_exact(FrameletPool const& pool, std::span<PixelRect const> changed, Picture& picture,
                    std::vector<PixelRect>& repainted);
    void start_moving(Viewport viewport, std::size_t blocks, bool is_blank);
    void flag_replanned(FrameletPool const& pool);
    /// A summary of the patches of the pool that are painted in a block.
    struct BlockPatches {
        std::uint64_t signature = 0; ///< of these patches
        bool in_place = false; ///< what shows is `reconstruct_block` of the newest cache
    };
    BlockPatches collect(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                         BodyMotions const& motions, int column, int row, std::vector<PatchView>& patches);
    std::size_t index_of(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    /// True when a block has to be looked at.
    bool is_wanted(std::size_t block) const {
        return replanned_[block] != 0 || (blocks_[block].slots & noted_slots_) != 0;
    }
    bool paint_blocks(FrameletPool const& pool, Camera const& camera, SceneTime scene_time, BodyMotions const& motions);
    bool paint_on(BlockCanvas& canvas, FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                  BodyMotions const& motions);
    /// Paints a block if that is needed; true when it was.
    bool update_block(FrameletPool const& pool, Camera const& camera, SceneTime scene_time, BodyMotions const& motions,
                      int column, int row, std::vector<PatchView>& patches);
    void show_cut(FrameletCache const& moment, Picture& picture, std::vector<PixelRect>& repainted);
    void count_blocks(std::size_t slots);
    template <class Work>
    void for_each_block(Work const& work);
    bool is_beside_hole(int column, int row) const;
    void fill();
    void filter(Picture& picture, std::vector<PixelRect>& repainted);

    ReprojectorParts parts_;
    bool has_shown_ = false;
    bool is_exact_ = false;
    bool is_on_canvas_ = false;
    double hole_share_ = 0;
    std::uint32_t noted_slots_ = 0; ///< a bit for each slot of which the plan knows what shows in the last picture
    std::size_t exact_slot_ = 0; ///< the one that an exact picture shows
    std::vector<WarpPlan> plans_; ///< by slot
    std::size_t newest_slot_ = 0; ///< the pool's at the time of the last plans
    std::uint32_t base_slots_ = 0; ///< likewise, a bit for each slot that belongs to the newest one
    std::vector<std::uint8_t> replanned_; ///< a flag for each block whose patches may be others than the last time
    int columns_ = 0, rows_ = 0; ///< of blocks
    std::vector<BlockState> blocks_;
    std::vector<FarMean> block_means_;
    std::vector<std::uint8_t> painted_; ///< a flag for each block
    std::vector<std::uint8_t> filtered_; ///< scratch, likewise
    Picture unfiltered_; ///< what was painted: the last picture is this, filtered. Not kept up while that is exact
    std::vector<std::uint32_t> shown_blocks_;
    FarMeans means_;
    std::vector<FarCells> cells_; ///< of blocks with holes and those beside them
    std::vector<float> inverse_depth_;
    std::vector<RowJobs> row_jobs_; ///< for a canvas
    std::vector<BlockReport> reports_; ///< scratch: a canvas's
};

} // namespace framelet
