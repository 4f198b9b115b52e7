#include "server/render/trace/tracing.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/light/luminance.h"
#include "server/render/surface/surface.h"
#include "server/render/trace/shading.h"

namespace framelet {
namespace {

/// Number of surfaces that a ray may pass, see-through or seen from behind, before the background ends it.
constexpr int most_layers = 32;

/// A smaller share of the light from behind a surface cannot be seen on a display of 8 bits.
constexpr float least_throughput = 1.0f / 512;

struct Compositing {
    LaneVec3 throughput; ///< share of the light from behind that is still seen
    LaneFloats weight; ///< largest share of a lane's light that one surface has had so far, mean of the colours
};

void add_background(PreparedScene const& scene, RayPacket const& rays, LaneMask missed, Footprint const& footprint,
                    Compositing const& state, TracedPacket& out) {
    for_each_lane(missed, [&](int i) {
        Vec3 const direction = rays.direction.get(i);
        float const spread = footprint.slope[i] / std::max(glm::length(direction), 1e-20f);
        Vec3 const through = state.throughput.get(i);
        out.radiance.set(i, out.radiance.get(i) + through * scene.environment.background(direction, spread));
        if (mean(through) > state.weight[i]) {
            out.depth[i] = INFINITY;
            out.surface.instance[i] = no_instance;
            out.light[i] = out.light_share[i] = 0;
        }
    });
}

void keep_light(ShadedPacket const& shaded, int i, TracedPacket& out) {
    out.light[i] = shaded.light[i];
    out.light_share[i] = shaded.light_share[i];
}

void keep_surface(HitPacket const& hits, SurfacePacket const& surfaces, ShadedPacket const& shaded, int i,
                  TracedPacket& out) {
    out.surface.t[i] = hits.t[i];
    out.surface.u[i] = hits.u[i];
    out.surface.v[i] = hits.v[i];
    out.surface.triangle[i] = hits.triangle[i];
    out.surface.geometry[i] = hits.geometry[i];
    out.surface.instance[i] = hits.instance[i];
    out.lost_light[i] = shaded.lost_light[i];
    if (shaded.lost_light[i] != no_light) {
        out.leaving.set(i, surfaces.leaving.get(i));
        out.facet.set(i, surfaces.geometric_normal.get(i));
    }
}

/// Composites opaque surfaces: what they send is all that is seen.
void add_opaque(ShadedPacket const& shaded, SurfacePacket const& surfaces, HitPacket const& hits, LaneMask present,
                bool moves, TracedPacket& out) {
    for_each_lane(present, [&](int i) {
        out.radiance.set(i, shaded.radiance.get(i));
        out.depth[i] = hits.t[i];
        keep_light(shaded, i, out);
    });
    if (moves) {
        for_each_lane(present, [&](int i) { keep_surface(hits, surfaces, shaded, i, out); });
    }
}

/// Composites surfaces that may be see-through; returns the lanes in which something behind them is still seen.
LaneMask add_layer(ShadedPacket const& shaded, SurfacePacket const& surfaces, HitPacket const& hits, LaneMask present,
                   bool moves, Compositing& state, TracedPacket& out) {
    LaneMask passed = 0;
    for_each_lane(present, [&](int i) {
        Vec3 const through = state.throughput.get(i);
        Vec3 const behind = through * shaded.passed.get(i);
        out.radiance.set(i, out.radiance.get(i) + through * shaded.radiance.get(i));
        state.throughput.set(i, behind);
        float const weight = mean(through) - mean(behind);
        if (weight > state.weight[i]) {
            state.weight[i] = weight;
            out.depth[i] = hits.t[i];
            keep_light(shaded, i, out);
            if (moves) {
                keep_surface(hits, surfaces, shaded, i, out);
            }
        }
        passed |= static_cast<LaneMask>(mean(behind) > least_throughput ? 1u : 0u) << i;
    });
    return passed;
}

/// Shades the lanes of `active`. `bounces`: how often light may still be followed along mirror reflections.
void shade(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& surfaces, LaneMask active,
           Footprint const& footprint, int bounces, ShadedPacket& out) {
    SurroundingLight around;
    find_surrounding_light(scene, hits, surfaces, active & ~surfaces.unlit, footprint, around);
    LobePacket lobes;
    MirrorRays mirror;
    shade_surroundings(scene, surfaces, around, active, bounces > 0, lobes, mirror, out);
    LaneFloats from_around;
    if (scene.light_cache != nullptr) {
        for_each_lane(active, [&](int i) {
            out.light[i] = luminance(around.diffuse.get(i));
            from_around[i] = luminance(out.radiance.get(i) - surfaces.emissive.get(i));
        });
    }
    if (mirror.lanes != 0) {
        TracedPacket reflected{};
        mirror.footprint.pixels = footprint.pixels;
        mirror.footprint.is_block = footprint.is_block;
        trace(scene, mirror.rays, mirror.lanes, mirror.footprint, bounces - 1, reflected);
        for_each_lane(mirror.lanes, [&](int i) {
            out.radiance.set(i, out.radiance.get(i) + mirror.share.get(i) * reflected.radiance.get(i));
        });
        out.segments += reflected.segments;
    }
    shade_lights(scene, surfaces, active, lobes, around.is_plane, out);
    if (scene.light_cache != nullptr) {
        for_each_lane(active, [&](int i) {
            float const all = luminance(out.radiance.get(i));
            out.light_share[i] = all > 0 ? std::clamp(from_around[i] / all, 0.0f, 1.0f) : 0.0f;
        });
    }
}

} // namespace

void continue_behind(HitPacket const& hits, LaneMask passed, LaneMask culled, RayPacket& rays) {
    for_each_lane(passed, [&](int i) { rays.near[i] = hits.t[i] * (1 + 0x1p-21f) + 1e-30f; });
    for_each_lane(culled, [&](int i) { rays.near[i] = std::max(rays.near[i], hits.t[i] * (1 - 0x1p-18f)); });
}

void trace(PreparedScene const& scene, RayPacket& rays, LaneMask active, Footprint const& footprint, int bounces,
           TracedPacket& out) {
    Compositing state;
    state.throughput.fill(Vec3(1));
    state.weight.fill(0);
    out.segments = 0;
    out.reflects = 0;
    for_each_lane(active, [&](int i) {
        out.radiance.set(i, Vec3(0));
        out.depth[i] = INFINITY;
        out.surface.instance[i] = no_instance;
        out.light[i] = out.light_share[i] = 0;
    });
    HitPacket hits{};
    SurfacePacket surfaces{}; // lanes that meet nothing are computed along with the others: on zeros
    ShadedPacket shaded{};
    EmbreeScene::Behind behind = EmbreeScene::Behind::stops;
    for (int layer = 0; active != 0 && layer < most_layers; ++layer) {
        out.segments += static_cast<std::uint32_t>(std::popcount(active));
        LaneMask const hit = scene.bvh.intersect(rays, active, behind, hits);
        add_background(scene, rays, active & ~hit, footprint, state, out);
        if (hit == 0) {
            return;
        }
        LaneMask const present = make_surfaces(scene.instances, rays, hits, hit, footprint, surfaces);
        LaneMask passed = 0;
        if (present != 0) {
            shade(scene, hits, surfaces, present, footprint, bounces, shaded);
            out.segments += shaded.segments;
            out.reflects |= shaded.reflects;
            if (scene.see_through) {
                passed |= add_layer(shaded, surfaces, hits, present, scene.moves, state, out);
            } else {
                add_opaque(shaded, surfaces, hits, present, scene.moves, out);
            }
        }
        LaneMask const culled = hit & ~present;
        continue_behind(hits, passed, culled, rays);
        active = passed | culled;
        behind = EmbreeScene::Behind::passes;
    }
    add_background(scene, rays, active, footprint, state, out);
}

} // namespace framelet
