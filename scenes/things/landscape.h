// The world around the vehicles: fields, a road along Z with markings, trees, houses, masts, far hills, the sun.
#pragma once

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// Everything along the road repeats after so many metres, so that an animation may loop after driving them.
inline constexpr double roadside_period = 120;
/// x of the middle of the lane of traffic towards +Z (it keeps to the right), and of the other one, metres.
inline constexpr double near_lane_x = -2;
inline constexpr double far_lane_x = 2;

/// Adds stretches first .. last (inclusive) of the road, each `roadside_period` long, stretch 0 centred on z = 0.
void add_roadside(GltfDocument& document, int first, int last);
/// A meadow about the origin, `side` metres square.
void add_meadow(GltfDocument& document, double side);
/// A paved yard beside the road, slabs of 2 m, centred on `center`.
void add_yard(GltfDocument& document, D3 center, D2 size);
/// Adds what is far away: a plain, a ring of hills, a sky with clouds up to 50 degrees (the sun shines in from above).
/// Returns the node of all this, which may ride along with a camera.
int add_surroundings(GltfDocument& document);
/// Adds sunlight that falls along -`towards_sun`, and by which a grey of 0.5 shows as 0.5 * cosine. The sun must stand
/// higher than 52 degrees where there is a sky.
void add_sun(GltfDocument& document, D3 towards_sun);
/// Adds a camera that looks from `eye` to `target`, both in the space of `parent`, metres. Returns its node.
int add_camera(GltfDocument& document, D3 eye, D3 target, double vertical_fov_degrees, int parent = no_index);
/// Adds one that goes `drift` metres to either side of `eye` and back within `duration` seconds.
void add_drifting_camera(GltfDocument& document, D3 eye, D3 target, double vertical_fov_degrees, double drift,
                         double duration);

} // namespace framelet
