#include "common/picture/confidence.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "common/picture/pool_plan.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;

/// The confidence of a pixel that shows a sample of this group, so of no hole.
PixelConfidence confidence_of(FrameletPool const& pool, SceneTime now, std::int32_t group) {
    std::size_t const slot = slot_of_group(group);
    HeldView const& view = pool.slot(slot).views()[view_of_group(group)];
    double const spacing = std::exp2(pool.plane().pixel_depth() - depth_of_group(group));
    return {static_cast<float>(std::abs(now - view.scene_time)), static_cast<float>(spacing)};
}

} // namespace

void find_confidence(FrameletPool const& pool, Camera const& camera, SceneTime scene_time, BodyMotions const& motions,
                     std::vector<PixelConfidence>& out) {
    Viewport const viewport = pool.plane().viewport();
    out.assign(static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height), {});
    PoolPlan plan(pool, camera, scene_time, motions);
    auto const find_in = [&](int column, int row, std::vector<PatchView>& patches) {
        WarpedBlock block;
        plan.paint(column, row, patches, block);
        int const left = column * side;
        int const top = row * side;
        for (int y = 0; y < std::min(side, viewport.height - top); ++y) {
            for (int x = 0; x < std::min(side, viewport.width - left); ++x) {
                auto const i = static_cast<std::size_t>(y * side + x);
                if (block.inverse_depth[i] != hole_depth) {
                    out[static_cast<std::size_t>(top + y) * static_cast<std::size_t>(viewport.width) +
                        static_cast<std::size_t>(left + x)] = confidence_of(pool, scene_time, block.group[i]);
                }
            }
        }
    };
    tbb::parallel_for(0, plan.rows(), [&](int row) {
        std::vector<PatchView> patches;
        for (int column = 0; column < plan.columns(); ++column) {
            find_in(column, row, patches);
        }
    });
}

} // namespace framelet
