#include "server/render/trace/shadow_motion.h"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/trace/sample_motion.h"
#include "server/render/trace/shading.h"

namespace framelet {
namespace {

/// Light that falls in flatter than this (sine) makes shadows that leap.
constexpr float least_steepness = 0.02f;
/// Speeds of shadows, metres a second: what is slower rests, what is faster is a leap.
constexpr float slowest = 0.01f, fastest = 200;
/// Velocities are multiples of this, metres a second: samples of one shadow get the very same velocity, so that their
/// layers can be joined.
constexpr float step = 1.0f / 32;

/// Rays to the light from each lane that has lost one.
struct LostLights {
    RayPacket rays;
    LaneFloats distance; ///< +infinity for directional lights
    LaneMask lanes = 0;
};

LaneMask static_lanes_in_shadow(PreparedScene const& scene, TracedPacket const& traced) {
    LaneMask lanes_in_shadow = 0;
    for (int i = 0; i < lanes; ++i) {
        std::uint32_t const number = traced.surface.instance[i];
        if (number != no_instance && traced.lost_light[i] != no_light && !scene.instances[number].moves()) {
            lanes_in_shadow |= 1u << i;
        }
    }
    return lanes_in_shadow;
}

/// Aims rays at the lights, as shading does.
void aim(PreparedScene const& scene, TracedPacket const& traced, LostLights& out) {
    out.rays.origin = traced.leaving;
    out.rays.near.fill(0);
    for_each_lane(out.lanes, [&](int i) {
        RenderLight const& light = scene.lights[traced.lost_light[i]];
        Vec3 to_light = light.towards;
        out.distance[i] = INFINITY;
        if (light.type != LightType::directional) {
            Vec3 const path = light.position - traced.leaving.get(i);
            out.distance[i] = std::sqrt(glm::dot(path, path) + 1e-20f);
            to_light = path / out.distance[i];
        }
        out.rays.direction.set(i, to_light);
        out.rays.far[i] = out.distance[i] * shadow_ray_share;
    });
}

Vec3 rounded(Vec3 const& velocity) {
    return step * glm::round(velocity / step);
}

/// Velocity of the point that throws the shadow. The shadow of what spins goes with its origin.
Vec3 velocity_of_occluder(Instance const& instance, HitPacket const& hits, int lane) {
    return instance.spins ? instance.translation_rate : velocity_at(instance, hits, lane);
}

/// Velocity of the shadow in lane `i`. Where occluders are behind one another, the outline of the one farther from the
/// surface is taken to show. Where both hits are on the same body it is the mean of both: the outline of a ball that
/// rolls goes with its middle, and half way between where a ray enters it and where it leaves it nothing turns but
/// along the ray.
Vec3 velocity_of_shadow(PreparedScene const& scene, TracedPacket const& traced, LostLights const& lost,
                        HitPacket const& nearest, HitPacket const& farthest, int i) {
    auto const thrown_by = [&](HitPacket const& hits) {
        return shadow_velocity(scene.lights[traced.lost_light[i]], traced.facet.get(i), lost.rays.direction.get(i),
                               lost.distance[i], hits.t[i],
                               velocity_of_occluder(scene.instances[hits.instance[i]], hits, i));
    };
    Vec3 const velocity = thrown_by(farthest);
    bool const one_body = scene.instances[nearest.instance[i]].body == scene.instances[farthest.instance[i]].body;
    return one_body ? 0.5f * (velocity + thrown_by(nearest)) : velocity;
}

} // namespace

Vec3 shadow_velocity(RenderLight const& light, Vec3 const& facet, Vec3 const& to_light, float distance_to_light,
                     float distance, Vec3 const& occluder) {
    float const steepness = glm::dot(to_light, facet);
    if (!(std::abs(steepness) > least_steepness)) {
        return Vec3(0);
    }
    Vec3 across = occluder;
    if (std::isfinite(distance_to_light)) { // what is near to the lamp throws its shadow so much farther
        float const scale = distance_to_light / (distance_to_light - distance);
        across = light.velocity + scale * (occluder - light.velocity);
    }
    Vec3 const along = across - to_light * (glm::dot(across, facet) / steepness);
    float const squared = glm::dot(along, along);
    return squared > slowest * slowest && squared < fastest * fastest ? along : Vec3(0);
}

std::uint32_t add_shadow_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out) {
    LostLights lost;
    lost.lanes = static_lanes_in_shadow(scene, traced);
    if (lost.lanes == 0) {
        return 0;
    }
    aim(scene, traced, lost);
    HitPacket nearest, farthest;
    LaneMask const moving = scene.bvh.intersect_moving(lost.rays, lost.lanes, scene.instances, nearest, farthest);
    for_each_lane(moving, [&](int i) {
        Vec3 const velocity = rounded(velocity_of_shadow(scene, traced, lost, nearest, farthest, i));
        if (velocity == Vec3(0)) {
            return;
        }
        if (out.velocity.empty()) {
            out.velocity.assign(framelet_samples, Vec3(0));
        }
        out.velocity[static_cast<std::size_t>(first + i)] = velocity;
    });
    return static_cast<std::uint32_t>(std::popcount(lost.lanes));
}

} // namespace framelet
