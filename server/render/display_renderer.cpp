#include "server/render/display_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/color.h"
#include "common/error.h"
#include "server/render/display_framelet.h"

namespace framelet {
namespace {

/// Moves all but the radiance, which would crowd the caches for nothing. Memory of `from` is reused.
void move_geometry(Framelet& from, Framelet& to) {
    to.tile = from.tile;
    to.depth = from.depth;
    to.body.swap(from.body);
    to.drift.swap(from.drift);
    to.light.swap(from.light);
    to.reflects = from.reflects;
    to.is_supersampled = false;
}

/// Inverse depths that differ by less than this share of the greater one are of one surface.
constexpr float same_surface = 0.05f;

/// The surface that most of four rays hit.
struct Majority {
    std::size_t ray = 0; ///< one of those that hit it
    float depth = 0; ///< mean of those that hit it, taken of their inverse depths; metres along the view
};

Majority majority_of(Framelet const& child, std::size_t first) {
    std::array<float, four_rays> inverse_depth;
    for (std::size_t i = 0; i < four_rays; ++i) {
        inverse_depth[i] = 1 / child.depth[first + i];
    }
    Majority best;
    int most = 0;
    for (std::size_t i = 0; i < four_rays; ++i) {
        int count = 0;
        float sum = 0;
        for (std::size_t k = 0; k < four_rays; ++k) {
            bool const same_body = child.body.empty() || child.body[first + i] == child.body[first + k];
            float const nearer = std::max(inverse_depth[i], inverse_depth[k]);
            if (same_body && std::abs(inverse_depth[i] - inverse_depth[k]) <= same_surface * nearer) {
                ++count;
                sum += inverse_depth[k];
            }
        }
        if (count > most) {
            most = count;
            best = {first + i, static_cast<float>(count) / sum};
        }
    }
    return best;
}

} // namespace

void merge_child(Framelet const& child, DisplayTransform const& transform, bool will_be_moved, Framelet& geometry,
                 DisplayFramelet& display) {
    constexpr std::size_t quarter = framelet_samples / four_rays;
    FRAMELET_CHECK(geometry.tile == child.tile.parent() && display.tile == geometry.tile);
    if (!child.body.empty()) {
        geometry.body.resize(framelet_samples, static_body);
    }
    if (!child.drift.empty()) {
        geometry.drift.resize(framelet_samples);
    }
    geometry.light.resize(child.light.size());
    std::size_t const first = (child.tile.code % four_rays) * quarter;
    for (std::size_t i = 0; i < quarter; ++i) {
        std::size_t const from = i * four_rays;
        std::size_t const to = first + i;
        Majority const majority = majority_of(child, from);
        bool const keeps_bodies_out = will_be_moved && !child.body.empty() && child.body[majority.ray] == static_body;
        Vec3 light(0);
        int count = 0;
        for (std::size_t ray = from; ray < from + four_rays; ++ray) {
            if (!keeps_bodies_out || child.body[ray] == static_body) {
                light += transform.shown(Vec3(child.red[ray], child.green[ray], child.blue[ray]));
                ++count;
            }
        }
        light *= 1.0f / static_cast<float>(count);
        display.red[to] = srgb_byte_from_linear(light.r);
        display.green[to] = srgb_byte_from_linear(light.g);
        display.blue[to] = srgb_byte_from_linear(light.b);
        geometry.depth[to] = majority.depth;
        geometry.reflects[to] = child.reflects[majority.ray];
        if (!child.light.empty()) {
            geometry.light[to] = child.light[majority.ray];
        }
        if (!child.body.empty()) {
            geometry.body[to] = child.body[majority.ray];
        }
        if (!child.drift.empty()) {
            geometry.drift[to] = child.drift[majority.ray];
        }
    }
}

std::uint32_t render_display(RenderScene const& scene, ViewRays const& rays, ImagePlane const& plane, Tile tile,
                             DisplayTransform const& transform, int rays_per_sample, bool will_be_moved,
                             Framelet& scratch, Framelet& geometry, DisplayFramelet& display) {
    FRAMELET_CHECK(rays_per_sample == single_ray || rays_per_sample == four_rays);
    if (rays_per_sample == single_ray) {
        std::uint32_t const segments = render_framelet(scene, rays, plane, tile, scratch);
        display = to_display(scratch, transform);
        move_geometry(scratch, geometry);
        return segments;
    }
    geometry.tile = display.tile = tile;
    geometry.body.clear();
    geometry.drift.clear();
    geometry.reflects.reset();
    geometry.is_supersampled = true;
    std::uint32_t segments = 0;
    for (std::uint32_t quadrant = 0; quadrant < four_rays; ++quadrant) {
        segments += render_framelet(scene, rays, plane, tile.child(quadrant), scratch);
        merge_child(scratch, transform, will_be_moved, geometry, display);
    }
    return segments;
}

} // namespace framelet
