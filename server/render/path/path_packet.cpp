#include "server/render/path/path_packet.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/cache/light_cache.h"
#include "server/render/light/luminance.h"
#include "server/render/path/path_random.h"
#include "server/render/prepared/light_frame.h"
#include "server/render/trace/tracing.h"

namespace framelet {
namespace {

/// Surfaces that a path may meet. Roulette ends nearly all long before.
constexpr int most_steps = 1000;
/// The largest chance to go on that roulette leaves.
constexpr float most_survival = 0.95f;

} // namespace

PathPacket::PathPacket(PathScene const& scene, PathOptions const& options, RayPacket& rays, Footprint& footprint,
                       PathNumbers const& numbers, LaneVec3& radiance)
    : paths_(scene), scene_(scene.scene), options_(options), rays_(rays), footprint_(footprint), numbers_(numbers),
      radiance_(radiance) {
    throughput_.fill(Vec3(1));
    density_.fill(INFINITY);
    radiance_.fill(Vec3(0));
}

void PathPacket::gather(LaneVec3 const& position, LaneVec3 const& normal, LaneMask active, GatheredLanes& out) {
    gathered_ = &out;
    out = {};
    surfaces_.position = surfaces_.leaving = position;
    surfaces_.normal = surfaces_.geometric_normal = surfaces_.view = normal;
    surfaces_.base_color.fill(Vec3(1));
    surfaces_.width = footprint_.width;
    surfaces_.spread = footprint_.slope;
    found_.fill(INFINITY);
    for_each_lane(active, [&](int i) {
        scattering_[static_cast<std::size_t>(i)] = scattering_of(surfaces_, i, scene_.split_sum, true);
    });
    if (options_.light_rays != LightRays::by_surface) {
        add_sampled_area_lights(active);
        add_sampled_sky(active);
    }
    if (options_.light_rays == LightRays::both && !paths_.lamp_rays.empty()) {
        add_lit_by_lamps(active);
    }
    LaneMask const alive = bounce_on(active);
    first_ = rays_.direction;
    follow_from(1, alive);
}

void PathPacket::follow(LaneMask active) {
    follow_from(0, active);
}

void PathPacket::follow_from(int step, LaneMask active) {
    EmbreeScene::Behind behind = EmbreeScene::Behind::stops;
    for (step_ = step; active != 0 && step_ < most_steps; ++step_) {
        LaneMask const hit = scene_.bvh.intersect(rays_, active, behind, hits_);
        note_first(active, hit);
        add_sky(active & ~hit);
        if (options_.light_rays != LightRays::to_lights) {
            add_met_lamps(active, hit);
        }
        LaneMask const present = make_surfaces(scene_.instances, rays_, hits_, hit, footprint_, surfaces_);
        note_density(present);
        add_emission(present);
        LaneMask passed = 0;
        LaneMask scattering = choose_scattering(present, passed);
        add_sampled_lamps(scattering);
        scattering &= ~add_known(scattering);
        if (options_.light_rays != LightRays::by_surface) {
            add_sampled_area_lights(scattering);
            add_sampled_sky(scattering);
        }
        if (options_.light_rays == LightRays::both && !paths_.lamp_rays.empty()) {
            add_lit_by_lamps(scattering);
        }
        LaneMask const culled = passes_behind(hit & ~present);
        continue_behind(hits_, passed, culled, rays_);
        active = passed | culled | bounce_on(scattering);
        behind = culled != 0 ? EmbreeScene::Behind::passes : EmbreeScene::Behind::stops;
    }
}

/// Notes what the first rays of what is gathered have met.
void PathPacket::note_first(LaneMask active, LaneMask hit) {
    if (gathered_ == nullptr || step_ != 1) {
        return;
    }
    for_each_lane(active & ~hit, [&](int i) { gathered_->open[i] = 1; });
    for_each_lane(hit, [&](int i) { gathered_->nearness[i] = 1 / std::max(hits_.t[i], 1e-10f); });
}

Vec2 PathPacket::random(int i, Pair pair) const {
    auto const dimension = 1 + static_cast<std::uint32_t>(step_) * pairs + pair;
    return random_pair(numbers_.pixel_seed[i], numbers_.sample[i], dimension);
}

/// Adds what arrives along a path; `is_sky`: straight from the environment at its beginning.
void PathPacket::add(int i, Vec3 const& light, bool is_sky) {
    radiance_.set(i, radiance_.get(i) + light);
    if (gathered_ != nullptr) {
        Vec3 const direction = step_ == 0 ? shadow_.direction.get(i) : first_.get(i);
        gathered_->lean.set(i, gathered_->lean.get(i) + direction * luminance(light));
        if (!is_sky) {
            gathered_->reflected.set(i, gathered_->reflected.get(i) + light);
        }
    }
}

Geometry const& PathPacket::geometry_of(HitPacket const& hits, int i) const {
    return scene_.instances[hits.instance[i]].geometries[hits.geometry[i]];
}

/// Notes how densely bounces find these surfaces.
void PathPacket::note_density(LaneMask present) {
    for_each_lane(present, [&](int i) {
        Vec3 const way = surfaces_.position.get(i) - from_.get(i);
        float const cosine = glm::dot(surfaces_.view.get(i), surfaces_.geometric_normal.get(i));
        found_[i] = bounced(i) ? density_[i] * cosine / glm::dot(way, way) : INFINITY;
    });
}

void PathPacket::add_sky(LaneMask missed) {
    if (paths_.sky.black()) {
        return;
    }
    for_each_lane(missed, [&](int i) {
        Vec3 const direction = rays_.direction.get(i);
        float const spread = bounced(i) ? 0 : footprint_.slope[i] / std::max(glm::length(direction), 1e-20f);
        float const share = met_share(i, paths_.sky.density(direction));
        add(i, throughput_.get(i) * scene_.environment.background(direction, spread) * share, step_ == 1);
    });
}

void PathPacket::add_emission(LaneMask present) {
    for_each_lane(present, [&](int i) {
        Vec3 const through = throughput_.get(i) * surfaces_.alpha[i];
        if ((surfaces_.unlit >> i & 1) != 0) {
            Vec3 const color = surfaces_.base_color.get(i);
            add(i, through * (bounced(i) ? color : scene_.unlit_radiance(color)));
            return;
        }
        Vec3 const emissive = surfaces_.emissive.get(i);
        if (mean(emissive) > 0) {
            Geometry const& geometry = geometry_of(hits_, i);
            float const cosine = glm::dot(surfaces_.view.get(i), surfaces_.geometric_normal.get(i));
            float const per_angle = hits_.t[i] * hits_.t[i] / std::max(cosine, 1e-6f);
            float const density = bounced(i) ? paths_.area_lights.density(geometry, hits_.triangle[i]) : 0.0f;
            add(i, through * emissive * met_share(i, density * per_angle));
        }
    });
}

/// Lanes that go on behind a back that is not drawn. Those that bounced do so where shadow rays do.
LaneMask PathPacket::passes_behind(LaneMask culled) const {
    return culled & (~bounced_ | lanes_where([&](int i) {
               return (culled >> i & 1) != 0 && geometry_of(hits_, i).material->see_through();
           }));
}

/// Chooses whether a path goes straight on behind the surface (`passed`) or is scattered by it (returned).
LaneMask PathPacket::choose_scattering(LaneMask present, LaneMask& passed) {
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
        float const back = unlit ? 0 : alpha * mean(albedo(scattering_[static_cast<std::size_t>(i)], scene_.split_sum));
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

/// Adds what arrives from all around where that is known already; returns those lanes.
LaneMask PathPacket::add_known(LaneMask scattering) {
    constexpr float cell_share = 0.1f; // of the way; with twice as much `interior` was 4% darker
    LaneMask known = 0;
    if (gathered_ == nullptr || options_.known == nullptr) {
        return known;
    }
    for_each_lane(scattering, [&](int i) {
        LightPlace const place =
            light_place(scene_, hits_.instance[i], surfaces_.leaving.get(i), surfaces_.geometric_normal.get(i));
        IncomingLight in;
        if (options_.known->find_known(place, cell_share * hits_.t[i], options_.known_pose, in)) {
            known |= 1u << i;
            add(i, throughput_.get(i) * albedo(scattering_[static_cast<std::size_t>(i)], scene_.split_sum) * in.all);
        }
    });
    return known;
}

/// Starts the next ray of each path; returns the lanes that have one.
LaneMask PathPacket::bounce_on(LaneMask scattering) {
    LaneMask alive = 0;
    for_each_lane(scattering, [&](int i) {
        Scattering const& s = scattering_[static_cast<std::size_t>(i)];
        Vec3 const direction = sample_scattering(s, random(i, bounce), random(i, lobe).x);
        Scattered const back = scattered(s, direction);
        if (!(back.density > 0) || !above_facet(i, direction)) {
            return;
        }
        Vec3 through = throughput_.get(i) * back.reflected / back.density;
        if (step_ >= options_.sure_bounces) {
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
        from_facet_.set(i, surfaces_.geometric_normal.get(i));
        from_found_[i] = found_[i];
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

} // namespace framelet
