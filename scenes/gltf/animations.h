// Makes keys for motions: along a line, round an axis, along any path, in jumps.
#pragma once

#include <functional>

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// A straight line at constant speed, from time 0 to `duration`.
GltfTrack line_track(int node, D3 from, D3 to, double duration);
/// Turns nodes about a unit axis at constant speed, by `angle` radians in all, keyed at least every 90 degrees.
GltfTrack spin_track(std::vector<int> nodes, D3 axis, double angle, double duration);
/// A track of `keys` + 1 keys, evenly spaced over the duration.
GltfTrack translation_track(int node, double duration, int keys, std::function<D3(double seconds)> const& at);
GltfTrack rotation_track(int node, double duration, int keys, std::function<DQuat(double seconds)> const& at);
/// A track of one value an interval, all intervals equally long, that jumps between them. The last value is held to
/// `duration`.
GltfTrack step_track(int node, GltfPath path, double duration, std::vector<D4> const& values);

/// A rotation as the x, y, z, w of a key.
D4 as_key(DQuat const& rotation);

} // namespace framelet
