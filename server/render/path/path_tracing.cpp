#include "server/render/path/path_tracing.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/light/brdf.h"
#include "server/render/path/lamps.h"
#include "server/render/path/path_random.h"
#include "server/render/path/scattering.h"
#include "server/render/trace/shading.h"
#include "server/render/trace/tracing.h"

namespace framelet {
namespace {

/// Surfaces that a path may meet. Roulette ends nearly all long before.
constexpr int most_steps = 1000;
/// Bounces after which roulette begins, and the largest chance to go on that it leaves.
constexpr int sure_bounces = 4;
constexpr float most_survival = 0.95f;

/// Pairs of random numbers that each step of a path takes.
enum Pair : std::uint32_t { roulette, choices, lamp_point, light_point, sky_point, bounce, lobe, pairs };

float mean(Vec3 const& v) {
    return (v.r + v.g + v.b) * (1.0f / 3.0f);
}

/// Weight of an estimate whose direction could have been found in another way as well: power heuristic ([Veach 1997]).
float power_share(float own, float other) {
    if (!(own > 0)) {
        return 0;
    }
    float const ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

class PathPacket {
public:
    PathPacket(PathScene const& scene, PathOptions const& options, RayPacket& rays, Footprint& footprint,
               PathNumbers const& numbers, LaneVec3& radiance)
        : paths_(scene), scene_(scene.scene), options_(options), rays_(rays), footprint_(footprint), numbers_(numbers),
          radiance_(radiance) {
        throughput_.fill(Vec3(1));
        density_.fill(0);
    }

    void follow(LaneMask active) {
        for_each_lane(active, [&](int i) { radiance_.set(i, Vec3(0)); });
        EmbreeScene::Behind behind = EmbreeScene::Behind::stops;
        for (step_ = 0; active != 0 && step_ < most_steps; ++step_) {
            LaneMask const hit = scene_.bvh.intersect(rays_, active, behind, hits_);
            add_sky(active & ~hit);
            if (options_.light_rays != LightRays::to_lights) {
                add_met_lamps(active, hit);
            }
            LaneMask const present = make_surfaces(scene_.instances, rays_, hits_, hit, footprint_, surfaces_);
            add_emission(present);
            LaneMask passed = 0;
            LaneMask const scattering = choose_scattering(present, passed);
            if (options_.light_rays != LightRays::by_surface) {
                add_sampled_area_lights(scattering);
                add_sampled_sky(scattering);
            }
            add_sampled_lamps(scattering);
            LaneMask const culled = hit & ~present;
            continue_behind(hits_, passed, culled, rays_);
            active = passed | culled | bounce_on(scattering);
            behind = culled != 0 ? EmbreeScene::Behind::passes : EmbreeScene::Behind::stops;
        }
    }

private:
    bool bounced(int i) const { return (bounced_ >> i & 1) != 0; }

    Vec2 random(int i, Pair pair) const {
        auto const dimension = 1 + static_cast<std::uint32_t>(step_) * pairs + pair;
        return random_pair(numbers_.pixel_seed[i], numbers_.sample[i], dimension);
    }

    void add(int i, Vec3 const& light) { radiance_.set(i, radiance_.get(i) + light); }

    /// Weight of light that a bounce has met, where rays to lights find it with this density, 1 / sr.
    float met_share(int i, float light_density) const {
        if (!bounced(i) || options_.light_rays == LightRays::by_surface) {
            return 1;
        }
        return options_.light_rays == LightRays::both ? power_share(density_[i], light_density) : 0.0f;
    }
    /// Weight of light that a ray to a light has found.
    float found_share(float light_density, float surface_density) const {
        return options_.light_rays == LightRays::both ? power_share(light_density, surface_density) : 1.0f;
    }

    void add_sky(LaneMask missed) {
        if (paths_.sky.black()) {
            return;
        }
        for_each_lane(missed, [&](int i) {
            Vec3 const direction = rays_.direction.get(i);
            float const spread = bounced(i) ? 0 : footprint_.slope[i] / std::max(glm::length(direction), 1e-20f);
            float const share = met_share(i, paths_.sky.density(direction));
            add(i, throughput_.get(i) * scene_.environment.background(direction, spread) * share);
        });
    }

    /// Lamps with a size that a bounce meets before its next surface. They are not seen themselves, as hard ones are.
    void add_met_lamps(LaneMask active, LaneMask hit) {
        if (!(options_.sizes.sun > 0 || options_.sizes.lamp > 0)) {
            return;
        }
        for_each_lane(active & bounced_, [&](int i) {
            float const sum = shine_of_lamps(scene_.lights, options_.sizes, from_.get(i), from_normal_.get(i), lamps_);
            float const end = (hit >> i & 1) != 0 ? hits_.t[i] : INFINITY;
            for (LampShine const& lamp : lamps_) {
                float const at = lamp.sine > 0 && lamp.weight > 0 ? lamp.met_at(rays_.direction.get(i)) : -1.0f;
                if (at > rays_.near[i] && at <= end) {
                    float const share = met_share(i, lamp.weight / (sum * lamp.angle()));
                    add(i, throughput_.get(i) * lamp.radiance() * share);
                }
            }
        });
    }

    void add_emission(LaneMask present) {
        for_each_lane(present, [&](int i) {
            Vec3 const through = throughput_.get(i) * surfaces_.alpha[i];
            if ((surfaces_.unlit >> i & 1) != 0) {
                add(i, through * surfaces_.base_color.get(i));
                return;
            }
            Vec3 const emissive = surfaces_.emissive.get(i);
            if (mean(emissive) > 0) {
                Geometry const& geometry = scene_.instances[hits_.instance[i]].geometries[hits_.geometry[i]];
                float const cosine = glm::dot(surfaces_.view.get(i), surfaces_.geometric_normal.get(i));
                float const per_angle = hits_.t[i] * hits_.t[i] / std::max(cosine, 1e-6f);
                float const density = bounced(i) ? paths_.area_lights.density(geometry, hits_.triangle[i]) : 0.0f;
                add(i, through * emissive * met_share(i, density * per_angle));
            }
        });
    }

    /// Chooses whether a path goes straight on behind the surface (`passed`) or is scattered by it (returned).
    LaneMask choose_scattering(LaneMask present, LaneMask& passed) {
        LaneMask scattering = 0;
        for_each_lane(present, [&](int i) {
            bool const unlit = (surfaces_.unlit >> i & 1) != 0;
            Vec3 behind(0);
            float const alpha = surfaces_.alpha[i];
            if (!unlit) {
                scattering_[static_cast<std::size_t>(i)] =
                    scattering_of(surfaces_, i, scene_.split_sum, options_.lambertian);
            }
            if (scene_.see_through) {
                float const transmission = unlit ? 0 : surfaces_.transmission[i] * alpha * entering_share;
                behind = Vec3(1 - alpha) + surfaces_.base_color.get(i) * transmission;
            }
            float const back =
                unlit ? 0 : alpha * mean_albedo(scattering_[static_cast<std::size_t>(i)], scene_.split_sum);
            float const chance = mean(behind) > 0 ? mean(behind) / (mean(behind) + back) : 0.0f;
            if (chance > 0 && random(i, roulette).x < chance) {
                passed |= 1u << i;
                throughput_.set(i, throughput_.get(i) * behind / chance);
            } else if (back > 0) {
                scattering |= 1u << i;
                throughput_.set(i, throughput_.get(i) * (alpha / (1 - chance)));
            }
        });
        return scattering;
    }

    /// Traces shadow rays and adds `light_` of the lanes that reach their light.
    void add_unshadowed(LaneMask lanes_lit) {
        if (lanes_lit == 0) {
            return;
        }
        shadow_.origin = surfaces_.leaving;
        shadow_.near.fill(0);
        transmittance_.fill(Vec3(1));
        LaneMask const blocked = scene_.bvh.occluded(shadow_, lanes_lit, transmittance_);
        for_each_lane(lanes_lit & ~blocked, [&](int i) { add(i, light_.get(i) * transmittance_.get(i)); });
    }

    bool above_facet(int i, Vec3 const& direction) const {
        return glm::dot(surfaces_.geometric_normal.get(i), direction) > 0;
    }

    void aim_shadow(int i, Vec3 const& direction, float distance, Vec3 const& light) {
        shadow_.direction.set(i, direction);
        shadow_.far[i] = distance * shadow_ray_share;
        light_.set(i, throughput_.get(i) * light);
    }

    void add_sampled_lamps(LaneMask lit) {
        LaneMask aimed = 0;
        for_each_lane(scene_.lights.empty() ? 0 : lit, [&](int i) {
            float const sum = shine_of_lamps(scene_.lights, options_.sizes, surfaces_.position.get(i),
                                             surfaces_.normal.get(i), lamps_);
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
            if (!(lamp->sine > 0)) {
                constexpr float least_alpha = sharpest_highlight * sharpest_highlight;
                Vec3 const reflected = scattered(s, lamp->to_light, least_alpha).reflected;
                float const cosine = glm::dot(surfaces_.normal.get(i), lamp->to_light);
                if (cosine > 0) {
                    // `reflected` has the cosine, `arriving` is of a surface that faces the light.
                    aim_shadow(i, lamp->to_light, lamp->distance, reflected * lamp->arriving / chance);
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
                           back.reflected * lamp->radiance() * (found_share(density, back.density) / density));
                aimed |= 1u << i;
            }
        });
        add_unshadowed(aimed);
    }

    void add_sampled_area_lights(LaneMask lit) {
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
                aim_shadow(i, direction, distance,
                           back.reflected * point.radiance * (found_share(density, back.density) / density));
                aimed |= 1u << i;
            }
        });
        add_unshadowed(aimed);
    }

    void add_sampled_sky(LaneMask lit) {
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
        add_unshadowed(aimed);
    }

    /// Starts the next ray of each path; returns the lanes that have one.
    LaneMask bounce_on(LaneMask scattering) {
        LaneMask alive = 0;
        for_each_lane(scattering, [&](int i) {
            Scattering const& s = scattering_[static_cast<std::size_t>(i)];
            Vec3 const direction = sample_scattering(s, random(i, bounce), random(i, lobe).x);
            Scattered const back = scattered(s, direction);
            if (!(back.density > 0) || !above_facet(i, direction)) {
                return;
            }
            Vec3 through = throughput_.get(i) * back.reflected / back.density;
            if (step_ >= sure_bounces) {
                float const survival = std::min(most_survival, std::max({through.r, through.g, through.b}));
                if (!(random(i, roulette).y < survival)) {
                    return;
                }
                through /= survival;
            }
            throughput_.set(i, through);
            density_[i] = back.density;
            from_.set(i, surfaces_.position.get(i));
            from_normal_.set(i, surfaces_.normal.get(i));
            rays_.origin.set(i, surfaces_.leaving.get(i));
            rays_.direction.set(i, direction);
            rays_.near[i] = 0;
            rays_.far[i] = INFINITY;
            footprint_.width[i] = surfaces_.width[i];
            footprint_.slope[i] = surfaces_.spread[i];
            alive |= 1u << i;
        });
        bounced_ |= alive;
        return alive;
    }

    PathScene const& paths_;
    PreparedScene const& scene_;
    PathOptions const& options_;
    RayPacket& rays_;
    Footprint& footprint_;
    PathNumbers const& numbers_;
    LaneVec3& radiance_;
    int step_ = 0;
    LaneMask bounced_ = 0; ///< lanes whose ray comes from a surface
    LaneVec3 throughput_;
    LaneFloats density_; ///< of the last bounce's direction, 1 / sr
    LaneVec3 from_, from_normal_; ///< the point where the last bounce was
    HitPacket hits_{};
    SurfacePacket surfaces_{};
    std::array<Scattering, lanes> scattering_{};
    RayPacket shadow_{};
    LaneVec3 light_{}, transmittance_{};
    std::vector<LampShine> lamps_; ///< scratch
};

} // namespace

void trace_paths(PathScene const& scene, PathOptions const& options, RayPacket& rays, LaneMask active,
                 Footprint footprint, PathNumbers const& numbers, LaneVec3& radiance) {
    PathPacket(scene, options, rays, footprint, numbers, radiance).follow(active);
}

} // namespace framelet
