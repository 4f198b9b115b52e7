#include "server/render/framelet_renderer.h"

#include <algorithm>
#include <atomic>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/render/flush_denormals.h"
#include "server/render/trace/sample_motion.h"
#include "server/render/trace/shadow_motion.h"
#include "server/render/trace/tracing.h"
#include "server/render/view_packet.h"

namespace framelet {
namespace {

/// Mirror reflections of mirror reflections end in the environment.
constexpr int mirror_bounces = 1;

Footprint sample_footprint(ViewRays const& view, float spacing) {
    Footprint footprint;
    footprint.width.fill(glm::length(view.origin_dx) * spacing);
    footprint.slope.fill(glm::length(view.direction_dx) * spacing);
    footprint.pixels.fill(spacing);
    footprint.is_block = true;
    return footprint;
}

} // namespace

std::uint32_t render_framelet(RenderScene const& scene, ViewRays const& view, ImagePlane const& plane, Tile tile,
                              Framelet& out) {
    FlushDenormals const flush;
    PixelRect const rect = plane.tile_rect(tile);
    Vec2 const corner(rect.left, rect.top);
    float const spacing = plane.sample_spacing(tile);
    Footprint const footprint = sample_footprint(view, spacing);
    TracedPacket traced{};
    std::uint32_t segments = 0;
    out.tile = tile;
    out.body.clear();
    out.drift.clear();
    out.light.resize(scene.prepared().light_cache != nullptr ? framelet_samples : 0);
    out.reflects.reset();
    for (int first = 0; first < framelet_samples; first += lanes) {
        auto const position = [&](int i) {
            std::uint32_t const sample = static_cast<std::uint32_t>(first + i);
            Vec2 const square(morton_x(sample), morton_y(sample));
            return corner + (square + 0.5f) * spacing;
        };
        RayPacket rays = rays_through(view, position);
        trace(scene.prepared(), rays, all_lanes, footprint, mirror_bounces, traced);
        segments += traced.segments;
        for (int i = 0; i < lanes; ++i) {
            std::size_t const sample = static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
            out.red[sample] = traced.radiance.x[i];
            out.green[sample] = traced.radiance.y[i];
            out.blue[sample] = traced.radiance.z[i];
            out.depth[sample] = traced.depth[i];
        }
        if (!out.light.empty()) {
            std::copy_n(traced.light.lane, lanes, out.light.begin() + first);
        }
        if (traced.reflects != 0) {
            out.reflects |= std::bitset<framelet_samples>(traced.reflects) << static_cast<std::size_t>(first);
        }
        if (scene.prepared().moves) {
            add_motion(scene.prepared(), traced, first, out);
            if (scene.prepared().throws_moving_shadows) {
                segments += add_shadow_motion(scene.prepared(), traced, first, out);
            }
        }
    }
    return segments;
}

std::uint64_t render_framelets(RenderScene const& scene, Camera const& camera, ImagePlane const& plane,
                               std::span<Tile const> tiles, std::span<Framelet> out) {
    FRAMELET_CHECK(tiles.size() == out.size());
    ViewRays const view = make_view_rays(camera, plane.viewport());
    std::atomic<std::uint64_t> segments{0};
    tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) {
        segments.fetch_add(render_framelet(scene, view, plane, tiles[i], out[i]), std::memory_order_relaxed);
    });
    return segments;
}

std::uint64_t render_samples(RenderScene const& scene, ViewRays const& view, std::span<Vec2 const> positions,
                             std::span<float const> spacings, std::span<Vec3> radiance, std::span<SampleLight> light) {
    FRAMELET_CHECK(positions.size() == radiance.size() && positions.size() == spacings.size());
    FRAMELET_CHECK(light.empty() || light.size() == positions.size());
    float const width = glm::length(view.origin_dx);
    float const slope = glm::length(view.direction_dx);
    std::atomic<std::uint64_t> segments{0};
    std::size_t const packets = (positions.size() + lanes - 1) / lanes;
    tbb::parallel_for(std::size_t(0), packets, [&](std::size_t packet) {
        FlushDenormals const flush;
        std::size_t const first = packet * lanes;
        std::size_t const count = std::min<std::size_t>(lanes, positions.size() - first);
        // Unused lanes of the last packet repeat its last position.
        auto const of_lane = [&](int i) { return first + std::min(static_cast<std::size_t>(i), count - 1); };
        Footprint footprint;
        for (int i = 0; i < lanes; ++i) {
            footprint.width[i] = width * spacings[of_lane(i)];
            footprint.slope[i] = slope * spacings[of_lane(i)];
            footprint.pixels[i] = spacings[of_lane(i)];
        }
        TracedPacket traced{};
        RayPacket rays = rays_through(view, [&](int i) { return positions[of_lane(i)]; });
        trace(scene.prepared(), rays, all_lanes, footprint, mirror_bounces, traced);
        for (std::size_t i = 0; i < count; ++i) {
            radiance[first + i] = traced.radiance.get(static_cast<int>(i));
        }
        for (std::size_t i = 0; i < count && !light.empty(); ++i) {
            light[first + i] = {traced.light[static_cast<int>(i)], traced.light_share[static_cast<int>(i)]};
        }
        segments.fetch_add(traced.segments, std::memory_order_relaxed);
    });
    return segments;
}

} // namespace framelet
