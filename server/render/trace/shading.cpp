#include "server/render/trace/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// Reflections are traced below the first roughness and come from the prefiltered environment above the second.
constexpr float traced_roughness = 0.15f;
constexpr float filtered_roughness = 0.25f;
/// A surface that reflects less than the first share of light has no reflection traced, above the second all of it is
/// traced.
constexpr float negligible_reflectance = 0.05f;
constexpr float full_reflectance = 0.12f;

float smooth_step(float from, float to, float x) {
    float const t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

void add_surroundings(SurfacePacket const& s, SurroundingLight const& around, LobePacket const& lobes, LaneMask lit,
                      bool may_reflect, MirrorRays& mirror, LaneVec3& radiance) {
    mirror.lanes = 0;
    for_each_lane(lit, [&](int i) {
        float const roughness = s.roughness[i];
        Vec3 const specular = lobes.specular.get(i);
        float traced = 0;
        if (may_reflect && roughness < filtered_roughness) {
            float const strength = std::max({specular.r, specular.g, specular.b});
            traced = (1 - smooth_step(traced_roughness, filtered_roughness, roughness)) *
                     smooth_step(negligible_reflectance, full_reflectance, strength);
        }
        if (traced > 0) {
            mirror.lanes |= 1u << i;
            mirror.share.set(i, specular * traced);
        }
        radiance.set(i, radiance.get(i) + lobes.diffuse.get(i) * around.diffuse.get(i) +
                            specular * around.specular.get(i) * (1 - traced));
    });
}

void aim_reflections(SurfacePacket const& s, MirrorRays& mirror) {
    mirror.rays.near.fill(0);
    mirror.rays.far.fill(INFINITY);
    mirror.rays.origin = s.leaving;
    for_each_lane(mirror.lanes, [&](int i) {
        Vec3 direction = mirrored(s, i);
        Vec3 const facet = s.geometric_normal.get(i);
        float const above = glm::dot(direction, facet);
        if (above < 0.01f) { // a bent normal sends the ray into the surface: along it instead
            direction = glm::normalize(direction + facet * (0.01f - above));
        }
        mirror.rays.direction.set(i, direction);
        mirror.footprint.width[i] = s.width[i];
        mirror.footprint.slope[i] = s.spread[i] + s.roughness[i] * s.roughness[i];
    });
}

/// Transmission replaces diffuse reflection by what is seen straight through, tinted by the base colour.
void split_transmission(SurfacePacket const& s, LaneMask active, LobePacket& lobes, ShadedPacket& out) {
    for_each_lane(active, [&](int i) {
        float const transmission = s.transmission[i];
        float const alpha = s.alpha[i];
        float const away = 1 - std::min(lobes.normal_view[i], 1.0f);
        float const entering =
            entering_share * (1 - (away * away) * (away * away) * away); // [Schlick 1994] with f0 = 0.04
        Vec3 const tint = s.base_color.get(i) * (transmission * entering);
        out.passed.set(i, Vec3(1 - alpha) + tint * alpha);
        lobes.diffuse.set(i, lobes.diffuse.get(i) * (1 - transmission));
    });
}

} // namespace

void shade_surroundings(PreparedScene const& scene, SurfacePacket const& s, SurroundingLight const& around,
                        LaneMask active, bool may_reflect, LobePacket& lobes, MirrorRays& mirror, ShadedPacket& out) {
    make_lobes(s.base_color, s.metallic, s.roughness, s.normal, s.view, lobes);
    if (scene.see_through) {
        split_transmission(s, active, lobes, out);
    }
    share_out(scene.split_sum, s.roughness, active & ~s.unlit, lobes);
    out.radiance = s.emissive;
    out.segments = 0;
    add_surroundings(s, around, lobes, active & ~s.unlit, may_reflect, mirror, out.radiance);
    out.reflects = mirror.lanes;
    if (mirror.lanes != 0) {
        aim_reflections(s, mirror);
    }
}

void shade_lights(PreparedScene const& scene, SurfacePacket const& s, LaneMask active, LobePacket const& lobes,
                  bool is_plane, ShadedPacket& out) {
    StrongestLight strongest;
    out.segments += add_lights(scene, s, lobes, active & ~s.unlit, is_plane, strongest, out.radiance);
    if (scene.moves) {
        out.lost_light = strongest.lost;
    }
    for_each_lane(active & s.unlit, [&](int i) { out.radiance.set(i, scene.unlit_radiance(s.base_color.get(i))); });
    if (scene.see_through) {
        for (int i = 0; i < lanes; ++i) {
            out.radiance.x[i] *= s.alpha[i];
            out.radiance.y[i] *= s.alpha[i];
            out.radiance.z[i] *= s.alpha[i];
        }
    }
}

} // namespace framelet
