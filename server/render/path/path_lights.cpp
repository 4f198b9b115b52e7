#include "server/render/path/path_packet.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/light/brdf.h"
#include "server/render/light/luminance.h"
#include "server/render/trace/lamp_shadows.h"
#include "server/render/trace/tracing.h"

namespace framelet {
namespace {

/// See-through surfaces that a ray from a lamp may pass.
constexpr int most_layers = 8;

/// Weight of an estimate whose direction could have been found in another way as well: power heuristic ([Veach 1997]).
float power_share(float own, float other) {
    if (!(own > 0)) {
        return 0;
    }
    float const ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

} // namespace

/// Weight of light that a bounce has met, where rays to lights find it with this density, 1 / sr.
float PathPacket::met_share(int i, float light_density) const {
    if (!bounced(i) || options_.light_rays == LightRays::by_surface) {
        return 1;
    }
    return options_.light_rays == LightRays::both ? power_share(density_[i], light_density) : 0.0f;
}

/// Weight of light that a ray to a light has found.
float PathPacket::found_share(float light_density, float surface_density) const {
    return options_.light_rays == LightRays::both ? power_share(light_density, surface_density) : 1.0f;
}

/// Weight of what a lamp lights at a point that a bounce has found with this density, 1 / m^2: rays from the lamp
/// find it as well.
float PathPacket::lit_share(float found, Vec3 const& facet, std::uint32_t lamp, LampShine const& shine) const {
    float const facing = glm::dot(facet, shine.to_light);
    if (options_.light_rays != LightRays::both || !(facing > 0)) {
        return 1;
    }
    return power_share(found, paths_.lamp_rays.density(lamp, shine.distance, options_.sizes.lamp) * facing);
}

bool PathPacket::above_facet(int i, Vec3 const& direction) const {
    return glm::dot(surfaces_.geometric_normal.get(i), direction) > 0;
}

void PathPacket::aim_shadow(int i, Vec3 const& direction, float distance, Vec3 const& light) {
    shadow_.direction.set(i, direction);
    shadow_.far[i] = distance;
    light_.set(i, throughput_.get(i) * light);
}

/// Traces shadow rays and adds `light_` of the lanes that reach their light.
void PathPacket::add_unshadowed(LaneMask lanes_lit, bool is_sky) {
    if (lanes_lit == 0) {
        return;
    }
    shadow_.origin = surfaces_.leaving;
    shadow_.near.fill(0);
    transmittance_.fill(Vec3(1));
    LaneMask const blocked = scene_.bvh.occluded(shadow_, lanes_lit, transmittance_);
    for_each_lane(lanes_lit & ~blocked, [&](int i) { add(i, light_.get(i) * transmittance_.get(i), is_sky); });
}

/// Lamps with a size that a bounce meets before its next surface. They are not seen themselves, as hard ones are.
void PathPacket::add_met_lamps(LaneMask active, LaneMask hit) {
    if (!(options_.sizes.sun > 0 || options_.sizes.lamp > 0) || (gathered_ != nullptr && step_ == 1)) {
        return;
    }
    for_each_lane(active & bounced_, [&](int i) {
        float const sum = shine_of_lamps(scene_.lights, options_.sizes, from_.get(i), from_normal_.get(i), lamps_);
        float const end = (hit >> i & 1) != 0 ? hits_.t[i] : INFINITY;
        for (LampShine const& lamp : lamps_) {
            float const at = lamp.sine > 0 && lamp.weight > 0 ? lamp.met_at(rays_.direction.get(i)) : -1.0f;
            if (at > rays_.near[i] && at <= end) {
                auto const number = static_cast<std::uint32_t>(&lamp - lamps_.data());
                float const share = met_share(i, lamp.weight / (sum * lamp.angle())) *
                                    lit_share(from_found_[i], from_facet_.get(i), number, lamp);
                add(i, throughput_.get(i) * lamp.radiance() * share);
            }
        }
    });
}

void PathPacket::add_sampled_lamps(LaneMask lit) {
    LaneMask aimed = 0;
    for_each_lane(scene_.lights.empty() ? 0 : lit, [&](int i) {
        float const sum =
            shine_of_lamps(scene_.lights, options_.sizes, surfaces_.position.get(i), surfaces_.normal.get(i), lamps_);
        if (!(sum > 0)) {
            return;
        }
        float rest = random(i, choices).x * sum;
        auto const lamp = std::ranges::find_if(lamps_, [&](LampShine const& l) {
            rest -= l.weight;
            return l.weight > 0 && rest < 0;
        });
        if (lamp == lamps_.end()) {
            return; // rounding
        }
        Scattering const& s = scattering_[static_cast<std::size_t>(i)];
        float const chance = lamp->weight / sum;
        float const own = lit_share(found_[i], surfaces_.geometric_normal.get(i),
                                    static_cast<std::uint32_t>(lamp - lamps_.begin()), *lamp);
        if (!(lamp->sine > 0)) {
            constexpr float least_alpha = sharpest_highlight * sharpest_highlight;
            Vec3 const reflected = scattered(s, lamp->to_light, least_alpha).reflected;
            float const cosine = glm::dot(surfaces_.normal.get(i), lamp->to_light);
            if (cosine > 0) {
                // `reflected` has the cosine, `arriving` is of a surface that faces the light.
                float const end = std::isinf(lamp->distance) ? INFINITY : lamp->distance - lamp_core;
                aim_shadow(i, lamp->to_light, end, reflected * lamp->arriving * (own / chance));
                aimed |= 1u << i;
            }
            return;
        }
        if (options_.light_rays == LightRays::by_surface) {
            return;
        }
        Vec3 const direction = sample_lamp(*lamp, random(i, lamp_point));
        Scattered const back = scattered(s, direction);
        if (back.density > 0 && above_facet(i, direction)) {
            float const density = chance / lamp->angle();
            float const distance = std::isinf(lamp->distance) ? INFINITY : std::max(lamp->met_at(direction), 0.0f);
            aim_shadow(i, direction, distance,
                       back.reflected * lamp->radiance() * (own * found_share(density, back.density) / density));
            aimed |= 1u << i;
        }
    });
    add_unshadowed(aimed);
}

void PathPacket::add_sampled_area_lights(LaneMask lit) {
    LaneMask aimed = 0;
    for_each_lane(paths_.area_lights.empty() ? 0 : lit, [&](int i) {
        LightPoint const point = paths_.area_lights.sample(random(i, choices).y, random(i, light_point));
        Vec3 const way = point.position - surfaces_.leaving.get(i);
        float const squared = glm::dot(way, way);
        float const distance = std::sqrt(squared);
        Vec3 const direction = way / std::max(distance, 1e-20f);
        float const facing = -glm::dot(direction, point.normal);
        float const cosine = point.both ? std::abs(facing) : facing;
        Scattered const back = scattered(scattering_[static_cast<std::size_t>(i)], direction);
        if (cosine > 1e-6f && squared > 1e-12f && back.density > 0 && mean(point.radiance) > 0 &&
            above_facet(i, direction)) {
            float const density = point.density * squared / cosine;
            aim_shadow(i, direction, distance * shadow_ray_share,
                       back.reflected * point.radiance * (found_share(density, back.density) / density));
            aimed |= 1u << i;
        }
    });
    add_unshadowed(aimed);
}

void PathPacket::add_sampled_sky(LaneMask lit) {
    LaneMask aimed = 0;
    for_each_lane(paths_.sky.black() ? 0 : lit, [&](int i) {
        Vec3 const direction = paths_.sky.sample(random(i, sky_point));
        Scattered const back = scattered(scattering_[static_cast<std::size_t>(i)], direction);
        float const density = paths_.sky.density(direction);
        if (back.density > 0 && density > 0 && above_facet(i, direction)) {
            aim_shadow(i, direction, INFINITY,
                       back.reflected * scene_.environment.background(direction, 0) *
                           (found_share(density, back.density) / density));
            aimed |= 1u << i;
        }
    });
    add_unshadowed(aimed, step_ == 0);
}

/// Follows a ray of a lamp from each lane to one of the surfaces that it lights: `lit_hits_`, and `light_` is what
/// is left of the light for the chance of having chosen this one. Returns the lanes that have found one.
LaneMask PathPacket::find_lit_points(LaneMask lanes_lit) {
    HitPacket hits{};
    LaneFloats chance;
    for_each_lane(lanes_lit, [&](int i) {
        Vec2 const chosen = random(i, lamp_ray);
        lamp_rays_[static_cast<std::size_t>(i)] =
            paths_.lamp_rays.sample(chosen.x, random(i, lamp_way), random(i, lamp_aside), options_.sizes.lamp);
        shadow_.origin.set(i, lamp_rays_[static_cast<std::size_t>(i)].origin);
        shadow_.direction.set(i, lamp_rays_[static_cast<std::size_t>(i)].direction);
        chance[i] = chosen.y;
        light_.set(i, Vec3(1));
    });
    shadow_.near.fill(0);
    shadow_.far.fill(INFINITY);
    LaneMask there = 0;
    for (int layer = 0; lanes_lit != 0 && layer < most_layers; ++layer) {
        LaneMask const hit = scene_.bvh.intersect(shadow_, lanes_lit, EmbreeScene::Behind::stops, hits);
        LaneMask passed = 0;
        for_each_lane(hit, [&](int i) {
            Geometry const& geometry = geometry_of(hits, i);
            Vec3 const behind = geometry.material->see_through()
                                    ? transmittance_at(geometry, hits.triangle[i], hits.u[i], hits.v[i])
                                    : Vec3(0);
            float const to_pass = mean(behind) / (1 + mean(behind));
            bool const passes = chance[i] < to_pass;
            light_.set(i, passes ? light_.get(i) * behind / to_pass : light_.get(i) / (1 - to_pass));
            chance[i] = passes ? chance[i] / to_pass : (chance[i] - to_pass) / (1 - to_pass);
            passed |= (passes ? 1u : 0u) << i;
        });
        for_each_lane(hit & ~passed, [&](int i) {
            lit_hits_.u[i] = hits.u[i];
            lit_hits_.v[i] = hits.v[i];
            lit_hits_.triangle[i] = hits.triangle[i];
            lit_hits_.geometry[i] = hits.geometry[i];
            lit_hits_.instance[i] = hits.instance[i];
            lit_points_.set(i, shadow_.origin.get(i) + shadow_.direction.get(i) * hits.t[i]);
        });
        there |= hit & ~passed;
        continue_behind(hits, passed, 0, shadow_);
        lanes_lit = passed;
    }
    return there;
}

/// Adds the light of points that lamps light, which bounces would rarely meet where these are near to their lamp.
void PathPacket::add_lit_by_lamps(LaneMask scattering) {
    LaneMask const there = find_lit_points(scattering);
    shadow_.origin = surfaces_.leaving;
    Footprint const footprint{surfaces_.width, surfaces_.spread, {}, false};
    for_each_lane(there, [&](int i) {
        Vec3 const way = lit_points_.get(i) - surfaces_.leaving.get(i);
        lit_hits_.t[i] = std::max(glm::length(way), 1e-10f);
        shadow_.direction.set(i, way / lit_hits_.t[i]);
    });
    LaneMask const seen = make_surfaces(scene_.instances, shadow_, lit_hits_, there, footprint, lit_);
    LaneMask aimed = 0;
    for_each_lane(seen & ~lit_.unlit, [&](int i) {
        Vec3 const light = light_.get(i) * light_of_lit_point(i);
        if (mean(light) > 0) {
            aim_shadow(i, shadow_.direction.get(i), lit_hits_.t[i] * shadow_ray_share, light);
            aimed |= 1u << i;
        }
    });
    add_unshadowed(aimed);
}

/// What the surface reflects of the light of this lane's lit point, were nothing between: an estimate for all
/// lamps.
Vec3 PathPacket::light_of_lit_point(int i) const {
    LampRay const& ray = lamp_rays_[static_cast<std::size_t>(i)];
    Vec3 const facet = lit_.geometric_normal.get(i);
    LampShine const shine = shine_of(scene_.lights[ray.lamp], options_.sizes, lit_.position.get(i), lit_.normal.get(i));
    Vec3 const direction = shadow_.direction.get(i);
    Scattered const back = scattered(scattering_[static_cast<std::size_t>(i)], direction);
    float const seen_cosine = glm::dot(lit_.view.get(i), facet);
    float const lit_cosine = -glm::dot(ray.direction, facet);
    float const found = back.density * seen_cosine / (lit_hits_.t[i] * lit_hits_.t[i]);
    float const share = 1 - lit_share(found, facet, ray.lamp, shine);
    float const density =
        paths_.lamp_rays.density(ray.lamp, shine.distance, options_.sizes.lamp) * std::max(lit_cosine, 1e-6f);
    if (!(back.density > 0 && above_facet(i, direction) && seen_cosine > 0 && lit_cosine > 0 && share > 0 &&
          shine.weight > 0 && density > 0)) {
        return Vec3(0);
    }
    Scattering const s = scattering_of(lit_, i, scene_.split_sum, options_.lambertian);
    float const least_alpha = shine.sine > 0 ? 0 : sharpest_highlight * sharpest_highlight;
    Vec3 const reflected = scattered(s, -ray.direction, least_alpha).reflected * shine.arriving;
    float const per_area = seen_cosine / (lit_hits_.t[i] * lit_hits_.t[i]);
    return back.reflected * reflected * (lit_.alpha[i] * per_area * share / density);
}

} // namespace framelet
