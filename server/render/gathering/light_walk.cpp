#include "server/render/gathering/light_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "common/error.h"
#include "common/framelet/framelet.h"
#include "server/render/framelet_renderer.h"
#include "server/render/path/path_random.h"

namespace framelet {
namespace {

/// Views from all places together: those of a house. More are for whoever comes.
constexpr std::size_t most_looks = 64;
constexpr std::size_t most_cameras = 16;
/// Square views of 2^(2 * 3) framelets. Cells are some pixels wide: few pixels ask for coarse ones, which show how
/// bright it is in all that viewers may ask for.
constexpr int side = 8 * framelet_side;
constexpr int tile_levels = 3;
constexpr float wide = 1.4f; ///< field of view, radians
/// New places a view, and what shares of the way to something that is seen they lie at: as far as one may walk.
constexpr std::uint32_t new_places = 2;
constexpr float nearest = 0.3f, farthest = 0.8f;

} // namespace

LightWalk::LightWalk(std::vector<Camera> cameras) : cameras_(std::move(cameras)) {
    FRAMELET_CHECK(!cameras_.empty());
    cameras_.resize(std::min(cameras_.size(), most_cameras));
}

bool LightWalk::is_over() const {
    return looks_ >= most_looks;
}

/// The first views are the cameras', then come views to anywhere, from one of the places.
Camera LightWalk::next_view() const {
    if (looks_ < cameras_.size()) {
        return cameras_[looks_];
    }
    Vec2 const toward = random_pair(0, looks_, 0);
    float const which = random_pair(0, looks_, 1).x;
    float const yaw = glm::two_pi<float>() * toward.x, pitch = 0.6f * (toward.y - 0.7f); // more down than up
    Vec3 const way(std::cos(pitch) * std::cos(yaw), std::sin(pitch), std::cos(pitch) * std::sin(yaw));
    Vec3 const place = places_[static_cast<std::size_t>(which * static_cast<float>(places_.size()))];
    return look_at(place, place + way, Vec3(0, 1, 0), wide);
}

void LightWalk::look(RenderScene const& scene) {
    Camera const camera = next_view();
    Viewport const viewport{side, side};
    ImagePlane const plane(viewport);
    std::vector<Tile> tiles;
    for (std::uint32_t code = 1u << (2 * tile_levels); code < 2u << (2 * tile_levels); ++code) {
        tiles.push_back({code});
    }
    std::vector<Framelet> seen(tiles.size());
    render_framelets(scene, camera, plane, tiles, seen);
    if (looks_ < cameras_.size()) {
        places_.push_back(camera.position);
    }
    ViewRays const rays = make_view_rays(camera, viewport);
    for (std::uint32_t i = 0; i < new_places; ++i) {
        Vec2 const at = random_pair(1 + i, looks_, 0) * static_cast<float>(side);
        auto const x = static_cast<std::uint32_t>(at.x), y = static_cast<std::uint32_t>(at.y);
        Framelet const& framelet = seen[morton_index(x / framelet_side, y / framelet_side)];
        float const depth = framelet.depth[morton_index(x % framelet_side, y % framelet_side)];
        if (std::isfinite(depth)) {
            float const share = nearest + (farthest - nearest) * random_pair(1 + i, looks_, 1).x;
            Vec3 const origin = rays.origin + rays.origin_dx * at.x + rays.origin_dy * at.y;
            Vec3 const way = rays.direction + rays.direction_dx * at.x + rays.direction_dy * at.y;
            places_.push_back(origin + way * (depth * share));
        }
    }
    ++looks_;
}

} // namespace framelet
