#include "common/picture/shown_point.h"

#include <cmath>

#include "common/picture/pool_plan.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
/// Cracks and the edges of what is torn are narrower than this; pixels.
constexpr int most_pixels_away = 4;

/// Of the pixel in that column and row of the block, or of its nearest neighbour in the block; `hole_depth`: none.
float inverse_depth_near(WarpedBlock const& block, int column, int row) {
    int nearest = most_pixels_away * most_pixels_away + 1;
    float out = hole_depth;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            int const distance = (x - column) * (x - column) + (y - row) * (y - row);
            float const inverse_depth = block.inverse_depth[static_cast<std::size_t>(y * side + x)];
            if (inverse_depth != hole_depth && distance < nearest) {
                nearest = distance;
                out = inverse_depth;
            }
        }
    }
    return out;
}

} // namespace

std::optional<Vec3> find_shown_point(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions, Vec2 place) {
    Viewport const viewport = pool.plane().viewport();
    if (!(place.x >= 0 && place.x < static_cast<float>(viewport.width) && place.y >= 0 &&
          place.y < static_cast<float>(viewport.height))) {
        return std::nullopt;
    }
    auto const x = static_cast<int>(place.x);
    auto const y = static_cast<int>(place.y);
    PoolPlan plan(pool, camera, scene_time, motions);
    std::vector<PatchView> patches;
    WarpedBlock block;
    plan.paint(x / side, y / side, patches, block);
    float const inverse_depth = inverse_depth_near(block, x % side, y % side);
    if (!(inverse_depth * max_camera_coordinate > 1)) {
        return std::nullopt;
    }
    ViewRays const rays = make_view_rays(camera, viewport);
    Vec3 const origin = rays.origin + place.x * rays.origin_dx + place.y * rays.origin_dy;
    Vec3 const direction = rays.direction + place.x * rays.direction_dx + place.y * rays.direction_dy;
    return origin + direction / inverse_depth;
}

} // namespace framelet
