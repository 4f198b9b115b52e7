#include "common/picture/shown_point.h"

#include <algorithm>
#include <limits>

#include "common/picture/pool_plan.h"

namespace framelet {

namespace {

constexpr int side = WarpedBlock::side;
/// Cracks and the edges of what is torn are narrower than this; pixels.
constexpr int most_pixels_away = 4;

/// The inverse depth of the pixel in that column and row of the block, or of its nearest neighbour in the block;
/// `hole_depth`: there is none.
float inverse_depth_near(WarpedBlock const& block, int column, int row) {
    float const own = block.inverse_depth[static_cast<std::size_t>(row * side + column)];
    if (own != hole_depth) {
        return own;
    }
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

/// True for what is so far that no camera's numbers reach there.
bool is_infinitely_far(float inverse_depth) {
    return !(inverse_depth * max_camera_coordinate > 1);
}

} // namespace

std::optional<Vec3> find_shown_point(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions, Vec2 position) {
    Viewport const viewport = pool.plane().viewport();
    if (!(position.x >= 0 && position.x < static_cast<float>(viewport.width) && position.y >= 0 &&
          position.y < static_cast<float>(viewport.height))) {
        return std::nullopt;
    }
    auto const x = static_cast<int>(position.x);
    auto const y = static_cast<int>(position.y);
    PoolPlan plan(pool, camera, scene_time, motions);
    std::vector<PatchView> patches;
    WarpedBlock block;
    plan.paint(x / side, y / side, patches, block);
    float const inverse_depth = inverse_depth_near(block, x % side, y % side);
    if (is_infinitely_far(inverse_depth)) {
        return std::nullopt;
    }
    ViewRays const rays = make_view_rays(camera, viewport);
    Vec3 const origin = rays.origin + position.x * rays.origin_dx + position.y * rays.origin_dy;
    Vec3 const direction = rays.direction + position.x * rays.direction_dx + position.y * rays.direction_dy;
    return origin + direction / inverse_depth;
}

std::vector<float> find_shown_depths(FrameletPool const& pool, Camera const& camera, SceneTime scene_time,
                                     BodyMotions const& motions) {
    Viewport const viewport = pool.plane().viewport();
    std::vector<float> out(static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height));
    PoolPlan plan(pool, camera, scene_time, motions);
    std::vector<PatchView> patches;
    WarpedBlock block;
    bool is_known = false;
    for (int row = 0; row < plan.rows(); ++row) {
        for (int column = 0; column < plan.columns(); ++column) {
            plan.paint(column, row, patches, block);
            for (int y = 0; y < std::min(side, viewport.height - row * side); ++y) {
                for (int x = 0; x < std::min(side, viewport.width - column * side); ++x) {
                    float const inverse_depth = inverse_depth_near(block, x, y);
                    is_known = is_known || inverse_depth > 0; // framelets without shapes are held as if infinitely far
                    out[static_cast<std::size_t>(row * side + y) * static_cast<std::size_t>(viewport.width) +
                        static_cast<std::size_t>(column * side + x)] = inverse_depth == hole_depth ? 0
                                                                       : is_infinitely_far(inverse_depth)
                                                                           ? std::numeric_limits<float>::infinity()
                                                                           : 1 / inverse_depth;
                }
            }
        }
    }
    return is_known ? out : std::vector<float>();
}

} // namespace framelet
