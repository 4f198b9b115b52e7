#include "server/render/path/path_picture.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/error.h"
#include "server/render/flush_denormals.h"
#include "server/render/path/path_random.h"
#include "server/render/path/path_tracing.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/view_packet.h"

namespace framelet {
namespace {

Vec3 mean_of_paths(PathScene const& scene, PathOptions const& options, ViewRays const& view, Vec2 corner,
                   std::uint32_t pixel_seed) {
    Footprint footprint;
    float const spacing = 1 / std::sqrt(static_cast<float>(options.paths));
    footprint.width.fill(glm::length(view.origin_dx) * spacing);
    footprint.slope.fill(glm::length(view.direction_dx) * spacing);
    PathNumbers numbers;
    LaneVec3 radiance;
    glm::dvec3 sum(0);
    for (int first = 0; first < options.paths; first += lanes) {
        auto const position = [&](int i) {
            numbers.pixel_seed[i] = pixel_seed;
            numbers.sample[i] = static_cast<std::uint32_t>(first + i);
            return corner + random_pair(pixel_seed, numbers.sample[i], 0);
        };
        RayPacket rays = rays_through(view, position);
        int const count = std::min(lanes, options.paths - first);
        LaneMask const active = all_lanes >> (lanes - count);
        trace_paths(scene, options, rays, active, footprint, numbers, radiance);
        for_each_lane(active, [&](int i) { sum += glm::dvec3(radiance.get(i)); });
    }
    return Vec3(sum / static_cast<double>(options.paths));
}

} // namespace

FloatImage render_paths(RenderScene const& scene, Camera const& camera, Viewport viewport, PathOptions const& options) {
    FRAMELET_CHECK(options.paths >= 1);
    PathScene const paths(scene.prepared());
    ViewRays const view = make_view_rays(camera, viewport);
    FloatImage picture(viewport.width, viewport.height);
    tbb::parallel_for(0, viewport.height, [&](int y) {
        FlushDenormals const flush;
        for (int x = 0; x < viewport.width; ++x) {
            std::uint32_t const seed =
                hashed(hashed(options.seed, static_cast<std::uint32_t>(y)), static_cast<std::uint32_t>(x));
            picture.at(x, y) = mean_of_paths(paths, options, view, Vec2(x, y), seed);
        }
    });
    return picture;
}

Picture to_display(FloatImage const& radiance, DisplayTransform const& transform) {
    Picture picture(radiance.width, radiance.height);
    for (std::size_t i = 0; i < radiance.rgb.size(); ++i) {
        Vec3 const shown = transform.shown(radiance.rgb[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            picture.rgba[i * 4 + c] = srgb_byte_from_linear(shown[static_cast<int>(c)]);
        }
        picture.rgba[i * 4 + 3] = 255;
    }
    return picture;
}

} // namespace framelet
