// Plans where all that a pool holds shows in the picture of a camera at a time, to look at parts of that picture. In:
// pool, camera, time, motions of bodies. Out: blocks of the picture, as `Reprojector::show` would paint them if the
// camera has not cut.
#pragma once

#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_pool.h"
#include "common/warp/warp_block.h"
#include "common/warp/warp_plan.h"

namespace framelet {

class PoolPlan {
public:
    PoolPlan(FrameletPool const& pool, Camera const& camera, SceneTime scene_time, BodyMotions const& motions)
        : viewport_(pool.plane().viewport()), plans_(pool.slot_count()) {
        for (std::size_t i = 0; i < plans_.size(); ++i) {
            plans_[i].make(pool.slot(i), i, pool.role(i), camera, scene_time, motions);
        }
    }

    int columns() const { return plans_[0].columns(); }
    int rows() const { return plans_[0].rows(); }

    /// Paints a block; different ones may be painted at the same time. `patches` is scratch.
    void paint(int column, int row, std::vector<PatchView>& patches, WarpedBlock& block) {
        patches.clear();
        for (WarpPlan& plan : plans_) {
            plan.add_block(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
                               static_cast<std::size_t>(column),
                           patches);
        }
        order(patches);
        paint_warped_block(patches, column, row, viewport_, block);
    }

private:
    Viewport viewport_;
    std::vector<WarpPlan> plans_;
};

} // namespace framelet
