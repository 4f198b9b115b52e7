// The picture from any camera at any scene time, from what is held (002, 003; ALGORITHMS: one homography a layer). In:
// cache, what changed in it, camera, time, motions of bodies. Out: the picture, and which parts of it changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/body_motion.h"
#include "common/hole_fill.h"
#include "common/image.h"
#include "common/warp_block.h"
#include "common/warp_plan.h"

namespace framelet {

/// Moves pictures. Keeps what it needs to know next time which blocks stay as they are; what it shows is a function of
/// its arguments only, whatever it showed before and however many threads there are.
class Reprojector {
public:
    /// Writes to `picture`, which has the viewport's size and, from the second call on, holds what the last one wrote.
    /// `changed` is what `FrameletCache::take_changed` gives: all that changed since the last call. `repainted` becomes
    /// the rectangles that may differ from the last call's, ordered as `take_changed` orders them.
    ///
    /// Where all that is held was taken with this camera and nothing in it has moved since, this is `reconstruct`, byte
    /// by byte; so is every block for which that holds while others move. Samples of or for an orthographic camera stay
    /// on their pixels. Where what is in place leaves holes the cache's spares show, and only there; where things lie
    /// around a hole, only what is behind them. All stays on its pixels where the camera has cut: where nearly nothing
    /// of what is held would show in the new view. Only blocks whose samples or their places differ from the last
    /// call's are painted.
    void show(FrameletCache const& cache, std::span<PixelRect const> changed, Camera const& camera,
              SceneTime scene_time, BodyMotions const& motions, Picture& picture, std::vector<PixelRect>& repainted);

    /// True when the last picture was `reconstruct`'s as a whole.
    bool is_exact() const { return is_exact_; }
    /// A plane of the picture's size, 1 / metres; `hole_depth` where the colour is only filled in. Not kept up while
    /// the picture is exact.
    std::span<float const> inverse_depth() const { return inverse_depth_; }
    /// Pixels of the last picture that nothing shows, in [0, 1]; 0 where it is exact.
    double hole_share() const { return hole_share_; }

private:
    struct BlockState {
        std::uint64_t signature = 0;
        std::uint64_t spare_signature = 0; ///< where they are needed
        std::int32_t holes = 0;
        bool needs_spares = false; ///< what is in place leaves holes
    };

    void show_exact(FrameletCache const& cache, std::span<PixelRect const> changed, Picture& picture,
                    std::vector<PixelRect>& repainted);
    void start_moving(Viewport viewport, std::size_t blocks);
    /// True when it had to be painted.
    bool update_block(FrameletCache const& cache, Camera const& camera, SceneTime scene_time,
                      BodyMotions const& motions, int column, int row, std::vector<PatchView>& patches,
                      std::vector<PatchView>& spares, Picture& picture);
    void count_holes(Picture const& picture);
    bool is_beside_hole(int column, int row) const;
    void fill(Picture& picture);

    bool has_shown_ = false;
    bool is_exact_ = false;
    double hole_share_ = 0;
    WarpPlan plan_;
    WarpPlan spare_plan_; ///< of what shows only in holes
    std::vector<BlockState> blocks_;
    std::vector<FarMean> block_means_;
    std::vector<std::uint8_t> painted_; ///< a flag for each block
    FarMeans means_;
    std::vector<FarCells> cells_; ///< of blocks with holes and those beside them
    std::vector<float> inverse_depth_;
};

} // namespace framelet
