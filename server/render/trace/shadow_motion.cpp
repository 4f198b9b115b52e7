#include "server/render/trace/shadow_motion.h"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/surface/hit_frame.h"
#include "server/render/trace/lamp_shadows.h"
#include "server/render/trace/sample_motion.h"
#include "server/render/trace/shading.h"

namespace framelet {
namespace {

/// Light that falls in flatter than this (sine) makes shadows that leap.
constexpr float least_steepness = 0.02f;
/// Speeds of shadows, metres a second: what is slower rests, what is faster is a leap.
constexpr float slowest = 0.01f, fastest = 200;

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

/// Where the point that throws a shadow is, now and at other times.
struct Occluder {
    Vec3 now{0};
    Course course{};
};

/// The shadow of what rolls goes with its origin.
Occluder occluder_of(Instance const& instance, HitPacket const& hits, int lane, Vec3 const& at) {
    Occluder occluder{at, course_of(instance, hits, lane)};
    for (std::size_t k = 0; k < motion_times && instance.rolls; ++k) {
        occluder.course[k] = at + (instance.elsewhen[k].translation - instance.translation);
    }
    return occluder;
}

/// The drift of the shadow in lane `i`. Where occluders are behind one another, the outline of the one farther from the
/// surface is taken to show. Where both hits are on the same instance it is the mean of both: the outline of a ball
/// that rolls goes with its middle, and half way between where a ray enters it and where it leaves it nothing turns but
/// along the ray.
Drift drift_of_shadow(PreparedScene const& scene, TracedPacket const& traced, LostLights const& lost,
                      HitPacket const& nearest, HitPacket const& farthest, int i) {
    std::uint32_t const light = traced.lost_light[i];
    Vec3 const on = traced.leaving.get(i), facet = traced.facet.get(i);
    float rounding = rounding_of(on);
    auto const thrown_by = [&](HitPacket const& hits) {
        Vec3 const at = on + hits.t[i] * lost.rays.direction.get(i);
        Occluder const occluder = occluder_of(scene.instances[hits.instance[i]], hits, i, at);
        rounding += rounding_of(at);
        Vec3 const now = shadow_of(occluder.now, scene.lights[light], on, facet);
        Course off;
        for (std::size_t k = 0; k < motion_times; ++k) {
            off[k] = shadow_of(occluder.course[k], scene.times.lights[k][light], on, facet) - now;
        }
        return off;
    };
    Course off = thrown_by(farthest);
    if (nearest.instance[i] == farthest.instance[i]) {
        Course const other = thrown_by(nearest);
        for (std::size_t k = 0; k < motion_times; ++k) {
            off[k] = 0.5f * (off[k] + other[k]);
        }
    }
    return drift_of(off, scene.times.usable, rounding);
}

/// False for shadows that are not worth following.
bool is_followed(Drift const& drift) {
    float const velocity = glm::length(drift.velocity);
    return velocity < fastest && velocity + motion_step * glm::length(drift.acceleration) > slowest;
}

} // namespace

Vec3 shadow_of(Vec3 const& point, RenderLight const& light, Vec3 const& on, Vec3 const& facet) {
    Vec3 const to_light =
        light.type == LightType::directional ? light.towards : unit_or(light.position - point, light.towards);
    float const steepness = glm::dot(to_light, facet);
    if (!(std::abs(steepness) > least_steepness)) {
        return Vec3(NAN);
    }
    return point - to_light * (glm::dot(point - on, facet) / steepness);
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
        Drift const drift = drift_of_shadow(scene, traced, lost, nearest, farthest, i);
        if (!is_followed(drift)) {
            return;
        }
        if (out.drift.empty()) {
            out.drift.assign(framelet_samples, Drift{});
        }
        out.drift[static_cast<std::size_t>(first + i)] = drift;
    });
    return static_cast<std::uint32_t>(std::popcount(lost.lanes));
}

} // namespace framelet
