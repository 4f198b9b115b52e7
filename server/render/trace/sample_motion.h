// Finds what carries the samples of a framelet: bodies by number, and drifts where they do more than that. In: traced
// packets. Out: a framelet's bodies and drifts, which stay empty where nothing moves.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/trace/tracing.h"

namespace framelet {

/// The jerk of what may deform and does not at present, metres a second cubed: it is no body all the same.
inline constexpr float least_jerk = 1e-5f;

/// Where a point is in the world, metres, at the other times of `MotionTimes`.
using Course = std::array<Vec3, motion_times>;

/// The course of the point of `instance` that a lane has met.
Course course_of(Instance const& instance, HitPacket const& hits, int lane);

/// The drift of what is off where it was taken to be by so much at the other times, metres: a parabola through the
/// present and the times about it, or as many of these as are `usable`; or what swings or goes round through them where
/// that misses the last two by less, which is the jerk. What is within `rounding` metres is 0.
Drift drift_of(Course const& off, std::array<bool, motion_times> const& usable, float rounding);

/// Metres by which positions of this size may be off by rounding.
float rounding_of(Vec3 const& position);

/// Adds the motion of the packet's lanes, samples `first` .. `first` + 15 of the framelet.
void add_motion(PreparedScene const& scene, TracedPacket const& traced, int first, Framelet& out);

} // namespace framelet
