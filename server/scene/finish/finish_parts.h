// The parts of `finish_scene`. Each checks and completes one kind of thing of a scene.
// In: a scene whose meshes are finished. Out: the same, as scene.h promises, or an InputError.
#pragma once

#include <algorithm>
#include <cmath>

#include "server/scene/reading/faults.h"
#include "server/scene/scene.h"

namespace framelet {

/// Largest coordinate that a vertex, a node or a key may have, metres: products of several stay finite in a float.
inline constexpr float max_coordinate = 1e9f;

/// Checks and completes the nodes: afterwards transforms are finite, rotations unit length, skins usable, morph weights
/// as many as targets.
void finish_nodes(Scene& scene);

/// Checks and completes the clips: afterwards keys are finite, their times increase, values fit, clips have their
/// duration; those that move nothing are removed.
void finish_clips(Scene& scene);

/// True where the number is finite, and at most `max_coordinate` without its sign.
inline bool in_range(float value) {
    return std::abs(value) <= max_coordinate;
}
inline bool in_range(Vec3 const& v) {
    return in_range(v.x) && in_range(v.y) && in_range(v.z);
}

/// The nearest number to `value` within [low, high]; `otherwise` where `value` is not finite.
inline float clamped(float value, float low, float high, float otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

} // namespace framelet
