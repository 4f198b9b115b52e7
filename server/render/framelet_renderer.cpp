#include "server/render/framelet_renderer.h"

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/render/flush_denormals.h"
#include "server/render/tracing.h"

namespace framelet {
namespace {

/// Mirror reflections of mirror reflections end in the environment.
constexpr int mirror_bounces = 1;

/// A good mix of the bits (Wellons, "lowbias32", 2018).
std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

/// Place of a sample in its cell, [0, 1)^2.
Vec2 place_in_cell(Seed seed, Tile tile, std::uint32_t sample) {
    if (seed == 0) {
        return Vec2(0.5f);
    }
    std::uint32_t const x = mixed(mixed(mixed(seed) ^ tile.code) + sample);
    std::uint32_t const y = mixed(x ^ 0x9e3779b9u);
    return {static_cast<float>(x >> 8) * 0x1p-24f, static_cast<float>(y >> 8) * 0x1p-24f};
}

} // namespace

void render_framelet(RenderScene const& scene, ViewRays const& view, ImagePlane const& plane, Tile tile, Seed seed,
                     Framelet& out) {
    FlushDenormals const flush;
    PixelRect const rect = plane.tile_rect(tile);
    float const spacing = plane.sample_spacing(tile);
    RayPacket rays;
    Footprint footprint;
    footprint.width.fill(glm::length(view.origin_dx) * spacing);
    footprint.slope.fill(glm::length(view.direction_dx) * spacing);
    TracedPacket traced{};
    out.tile = tile;
    for (int first = 0; first < framelet_samples; first += lanes) {
        for (int i = 0; i < lanes; ++i) {
            std::uint32_t const sample = static_cast<std::uint32_t>(first + i);
            Vec2 const in_cell = place_in_cell(seed, tile, sample);
            float const x =
                static_cast<float>(rect.left) + (static_cast<float>(morton_x(sample)) + in_cell.x) * spacing;
            float const y = static_cast<float>(rect.top) + (static_cast<float>(morton_y(sample)) + in_cell.y) * spacing;
            rays.origin.set(i, view.origin + view.origin_dx * x + view.origin_dy * y);
            rays.direction.set(i, view.direction + view.direction_dx * x + view.direction_dy * y);
        }
        rays.near.fill(0);
        rays.far.fill(INFINITY);
        trace(scene.prepared(), rays, all_lanes, footprint, mirror_bounces, traced);
        for (int i = 0; i < lanes; ++i) {
            std::size_t const sample = static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
            out.red[sample] = traced.radiance.x[i];
            out.green[sample] = traced.radiance.y[i];
            out.blue[sample] = traced.radiance.z[i];
            out.depth[sample] = traced.depth[i];
        }
    }
}

void render_framelets(RenderScene const& scene, Camera const& camera, ImagePlane const& plane,
                      std::span<Tile const> tiles, Seed seed, std::span<Framelet> out) {
    FRAMELET_CHECK(tiles.size() == out.size());
    ViewRays const view = make_view_rays(camera, plane.viewport());
    tbb::parallel_for(std::size_t(0), tiles.size(),
                      [&](std::size_t i) { render_framelet(scene, view, plane, tiles[i], seed, out[i]); });
}

} // namespace framelet
