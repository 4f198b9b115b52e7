#include "server/render/trace/sample_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/surface/hit_frame.h"

namespace framelet {
namespace {

/// The body that carries what a lane has met.
BodyNumber body_at(Instance const& instance, HitPacket const& hits, int lane) {
    Geometry const& geometry = instance.geometries[hits.geometry[lane]];
    return geometry.bodies.empty() ? instance.body : geometry.bodies[hits.triangle[lane]];
}

Vec3 position_at(Instance const& instance, HitPacket const& hits, int lane) {
    Geometry const& geometry = instance.geometries[hits.geometry[lane]];
    TrianglePoint const point = point_of(geometry, hits.triangle[lane], hits.u[lane], hits.v[lane]);
    return instance.linear * point.interpolate(geometry.positions) + instance.translation;
}

/// The drift of what a lane has met besides what its body does.
Drift drift_at(PreparedScene const& scene, Instance const& instance, HitPacket const& hits, int lane, BodyNumber body) {
    Vec3 const now = position_at(instance, hits, lane);
    Course off = course_of(instance, hits, lane);
    for (std::size_t k = 0; k < motion_times; ++k) {
        off[k] -= scene.times.of_body[k][body].of(now);
    }
    return drift_of(off, scene.times.usable, rounding_of(now));
}

/// The drift of this swing that was at `before` and will be at `after`, one step from now.
Drift through(Vec3 const& before, Vec3 const& after, SwingCode swing) {
    Drift drift;
    drift.swing = swing;
    drift.velocity = drift.acceleration = Vec3(1);
    float const along = 0.5f * (drift.after(motion_step).x - drift.after(-motion_step).x);
    float const across = 0.5f * (drift.after(motion_step).x + drift.after(-motion_step).x);
    drift.velocity = (after - before) / (2 * along);
    drift.acceleration = (after + before) / (2 * across);
    return drift;
}

/// The swing of what goes x'' = -rate^2 (x - middle): second differences of three places one step apart are
/// -2 (1 - cos(rate step)) times how far that is off the middle.
SwingCode swing_of(Course const& off) {
    constexpr float largest = 1.5f; // of that factor, or places a step apart say little
    Vec3 const &before = off[0], &after = off[1], &later = off[2];
    Vec3 const change = (later - 2.0f * after) - (after + before);
    float const factor = -glm::dot(change, after) / std::max(glm::dot(after, after), 1e-30f);
    return swing_code(factor > 0 && factor < largest ? std::acos(1 - 0.5f * factor) / motion_step : 0);
}

/// The jerk by which a drift misses what comes later. A cubic of some jerk adds jerk step^2 / 6 to the velocity, and
/// after n steps misses by (n^3 - n) / 6 jerk step^3.
float jerk_of(Drift const& drift, Course const& off, std::array<bool, motion_times> const& usable, float rounding) {
    constexpr float step = motion_step;
    auto const missed_by = [&](std::size_t time, float steps) {
        float const missed = usable[time] ? glm::length(off[time] - drift.after(steps * step)) : 0.0f;
        return missed > rounding ? 6 * missed / ((steps * steps - 1) * steps * step * step * step) : 0.0f;
    };
    return std::max(missed_by(2, 2), missed_by(3, 6));
}

} // namespace

Course course_of(Instance const& instance, HitPacket const& hits, int lane) {
    Geometry const& geometry = instance.geometries[hits.geometry[lane]];
    TrianglePoint const point = point_of(geometry, hits.triangle[lane], hits.u[lane], hits.v[lane]);
    Course course;
    for (std::size_t k = 0; k < motion_times; ++k) {
        course[k] = geometry.elsewhen[k].empty() ? instance.elsewhen[k].of(point.interpolate(geometry.positions))
                                                 : point.interpolate(geometry.elsewhen[k]);
    }
    return course;
}

float rounding_of(Vec3 const& position) {
    constexpr float share = 2e-6f; // of sums of products of single-precision numbers
    return share * (std::abs(position.x) + std::abs(position.y) + std::abs(position.z));
}

Drift drift_of(Course const& off, std::array<bool, motion_times> const& usable, float rounding) {
    constexpr float step = motion_step;
    Vec3 const &before = off[0], &after = off[1], &later = off[2];
    Drift drift;
    if (usable[0] && usable[1]) {
        drift = through(before, after, 0);
        drift.jerk = jerk_of(drift, off, usable, rounding);
        if (usable[2] && drift.jerk > 0) {
            Drift swinging = through(before, after, swing_of(off));
            swinging.jerk = jerk_of(swinging, off, usable, rounding);
            drift = swinging.jerk < drift.jerk ? swinging : drift;
        }
    } else if (usable[1] && usable[2]) {
        drift.velocity = (4.0f * after - later) / (2 * step);
        drift.acceleration = (later - 2.0f * after) / (step * step);
    } else if (usable[0] || usable[1]) {
        drift.velocity = usable[1] ? after / step : -before / step;
    }
    bool const rests =
        glm::length(drift.velocity) * step <= rounding && glm::length(drift.acceleration) * step * step <= 2 * rounding;
    if (rests) {
        drift.velocity = drift.acceleration = Vec3(0);
        drift.swing = 0;
    }
    bool const is_finite =
        std::isfinite(glm::dot(drift.velocity, Vec3(1)) + glm::dot(drift.acceleration, Vec3(1)) + drift.jerk);
    return is_finite ? drift : Drift{};
}

void add_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out) {
    for (int i = 0; i < lanes; ++i) {
        std::uint32_t const number = traced.surface.instance[i];
        if (number == no_instance) {
            continue;
        }
        Instance const& instance = scene.instances[number];
        if (!instance.moves()) {
            continue;
        }
        auto const sample = static_cast<std::size_t>(first + i);
        BodyNumber const body = body_at(instance, traced.surface, i);
        if (body != static_body) {
            if (out.body.empty()) {
                out.body.assign(framelet_samples, static_body);
            }
            out.body[sample] = body;
        }
        if (instance.flows) {
            if (out.drift.empty()) {
                out.drift.assign(framelet_samples, Drift{});
            }
            out.drift[sample] = drift_at(scene, instance, traced.surface, i, body);
            out.drift[sample].jerk = std::max(out.drift[sample].jerk, least_jerk);
        }
    }
}

} // namespace framelet
