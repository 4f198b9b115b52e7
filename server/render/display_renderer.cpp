#include "server/render/display_renderer.h"

#include "common/color.h"
#include "common/error.h"

namespace framelet {
namespace {

/// All but the radiance, which would crowd the caches for nothing; what `from` has room for is reused.
void move_geometry(Framelet& from, Framelet& to) {
    to.tile = from.tile;
    to.depth = from.depth;
    to.body.swap(from.body);
    to.velocity.swap(from.velocity);
    to.reflects = from.reflects;
}

} // namespace

void merge_child(Framelet const& child, float exposure, Framelet& geometry, DisplayFramelet& display) {
    constexpr std::size_t quarter = framelet_samples / four_rays;
    FRAMELET_CHECK(geometry.tile == child.tile.parent() && display.tile == geometry.tile);
    if (!child.body.empty()) {
        geometry.body.resize(framelet_samples, static_body);
    }
    if (!child.velocity.empty()) {
        geometry.velocity.resize(framelet_samples, Vec3(0));
    }
    std::size_t const first = (child.tile.code % four_rays) * quarter;
    for (std::size_t i = 0; i < quarter; ++i) {
        std::size_t const from = i * four_rays;
        std::size_t const to = first + i;
        Vec3 light(0);
        for (std::size_t ray = from; ray < from + four_rays; ++ray) {
            light += tone_map(Vec3(child.red[ray], child.green[ray], child.blue[ray]) * exposure);
        }
        light *= 1.0f / four_rays;
        display.red[to] = srgb_byte_from_linear(light.r);
        display.green[to] = srgb_byte_from_linear(light.g);
        display.blue[to] = srgb_byte_from_linear(light.b);
        geometry.depth[to] = child.depth[from];
        geometry.reflects[to] = child.reflects[from];
        if (!child.body.empty()) {
            geometry.body[to] = child.body[from];
        }
        if (!child.velocity.empty()) {
            geometry.velocity[to] = child.velocity[from];
        }
    }
}

std::uint32_t render_display(RenderScene const& scene, ViewRays const& rays, ImagePlane const& plane, Tile tile,
                             float exposure, int rays_per_sample, Framelet& scratch, Framelet& geometry,
                             DisplayFramelet& display) {
    FRAMELET_CHECK(rays_per_sample == single_ray || rays_per_sample == four_rays);
    if (rays_per_sample == single_ray) {
        std::uint32_t const segments = render_framelet(scene, rays, plane, tile, 0, scratch);
        display = to_display(scratch, exposure);
        move_geometry(scratch, geometry);
        return segments;
    }
    geometry.tile = display.tile = tile;
    geometry.body.clear();
    geometry.velocity.clear();
    geometry.reflects.reset();
    std::uint32_t segments = 0;
    for (std::uint32_t quadrant = 0; quadrant < four_rays; ++quadrant) {
        segments += render_framelet(scene, rays, plane, tile.child(quadrant), 0, scratch);
        merge_child(scratch, exposure, geometry, display);
    }
    return segments;
}

} // namespace framelet
