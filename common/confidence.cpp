#include "common/confidence.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "common/warp_block.h"
#include "common/warp_plan.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;

/// Of a pixel of the block that is no hole.
PixelConfidence confidence_of(FrameletCache const& cache, SceneTime now, std::int32_t group, bool is_spare) {
    HeldView const& view = cache.views()[view_of_group(group)];
    double const spacing = std::exp2(cache.plane().pixel_depth() - depth_of_group(group));
    return {static_cast<float>(std::abs(now - view.scene_time)), static_cast<float>(spacing), is_spare};
}

} // namespace

void find_confidence(FrameletCache const& cache, Camera const& camera, SceneTime scene_time, BodyMotions const& motions,
                     std::vector<PixelConfidence>& out) {
    Viewport const viewport = cache.plane().viewport();
    out.assign(static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height), {});
    WarpPlan plan, spare_plan;
    plan.make(cache, camera, scene_time, motions);
    spare_plan.make_spares(cache, camera, scene_time, motions);
    auto const find_in = [&](int column, int row, std::vector<PatchView>& patches) {
        std::size_t const index =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(plan.columns()) + static_cast<std::size_t>(column);
        WarpedBlock block, behind;
        plan.block(index, patches);
        paint_warped_block(patches, column, row, viewport, block);
        std::array<float, WarpedBlock::pixels> const in_place = block.inverse_depth;
        spare_plan.block(index, patches);
        paint_holes(patches, column, row, viewport, block, behind);
        int const left = column * side;
        int const top = row * side;
        show_in_holes(behind, viewport.width - left, viewport.height - top, block);
        for (int y = 0; y < std::min(side, viewport.height - top); ++y) {
            for (int x = 0; x < std::min(side, viewport.width - left); ++x) {
                auto const i = static_cast<std::size_t>(y * side + x);
                if (block.inverse_depth[i] != hole_depth) {
                    out[static_cast<std::size_t>(top + y) * static_cast<std::size_t>(viewport.width) +
                        static_cast<std::size_t>(left + x)] =
                        confidence_of(cache, scene_time, block.group[i], in_place[i] == hole_depth);
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
