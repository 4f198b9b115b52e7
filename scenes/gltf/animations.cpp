#include "scenes/gltf/animations.h"

#include <cmath>

namespace framelet {

D4 as_key(DQuat const& rotation) {
    return {rotation.x, rotation.y, rotation.z, rotation.w};
}

GltfTrack line_track(int node, D3 from, D3 to, double duration) {
    return {{node}, GltfPath::translation, false, {0, duration}, {D4(from, 0), D4(to, 0)}};
}

GltfTrack spin_track(std::vector<int> nodes, D3 axis, double angle, double duration) {
    GltfTrack track{std::move(nodes), GltfPath::rotation, false, {}, {}};
    int const keys = static_cast<int>(std::ceil(std::abs(angle) / (pi / 2) - 1e-9));
    for (int key = 0; key <= keys; ++key) {
        track.times.push_back(duration * key / keys);
        track.values.push_back(as_key(rotation_about(axis, angle * key / keys)));
    }
    return track;
}

GltfTrack translation_track(int node, double duration, int keys, std::function<D3(double)> const& at) {
    GltfTrack track{{node}, GltfPath::translation, false, {}, {}};
    for (int key = 0; key <= keys; ++key) {
        track.times.push_back(duration * key / keys);
        track.values.push_back(D4(at(track.times.back()), 0));
    }
    return track;
}

GltfTrack rotation_track(int node, double duration, int keys, std::function<DQuat(double)> const& at) {
    GltfTrack track{{node}, GltfPath::rotation, false, {}, {}};
    for (int key = 0; key <= keys; ++key) {
        track.times.push_back(duration * key / keys);
        D4 value = as_key(at(track.times.back()));
        if (key > 0 && glm::dot(value, track.values.back()) < 0) {
            value = -value; // the same rotation, on the shorter way from the last key
        }
        track.values.push_back(value);
    }
    return track;
}

GltfTrack step_track(int node, GltfPath path, double duration, std::vector<D4> const& values) {
    GltfTrack track{{node}, path, true, {}, values};
    for (std::size_t key = 0; key < values.size(); ++key) {
        track.times.push_back(duration * static_cast<double>(key) / static_cast<double>(values.size()));
    }
    track.times.push_back(duration);
    track.values.push_back(values.back());
    return track;
}

} // namespace framelet
