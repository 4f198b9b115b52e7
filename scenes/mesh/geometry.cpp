#include "scenes/mesh/geometry.h"

#include <algorithm>
#include <cmath>

namespace framelet {

double smooth_step(double t) {
    double const x = std::clamp(t, 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

DQuat rotation_about(D3 axis, double angle) {
    double const s = std::sin(angle / 2);
    return {std::cos(angle / 2), axis.x * s, axis.y * s, axis.z * s};
}

DQuat looking_at(D3 eye, D3 target) {
    D3 const view = target - eye;
    double const yaw = std::atan2(-view.x, -view.z);
    double const pitch = std::atan2(view.y, std::hypot(view.x, view.z));
    return rotation_about({0, 1, 0}, yaw) * rotation_about({1, 0, 0}, pitch);
}

void append(MeshData& mesh, MeshData const& part, Placement const& place) {
    auto const first = static_cast<std::uint32_t>(mesh.positions.size());
    for (D3 const& position : part.positions) {
        mesh.positions.push_back(place.translation + place.rotation * (place.scale * position));
    }
    for (D3 const& normal : part.normals) {
        mesh.normals.push_back(glm::normalize(place.rotation * (normal / place.scale)));
    }
    mesh.uv.insert(mesh.uv.end(), part.uv.begin(), part.uv.end());
    mesh.colors.insert(mesh.colors.end(), part.colors.begin(), part.colors.end());
    mesh.joint_weights.insert(mesh.joint_weights.end(), part.joint_weights.begin(), part.joint_weights.end());
    for (std::uint32_t const index : part.indices) {
        mesh.indices.push_back(first + index);
    }
}

double random_unit(std::uint32_t seed, std::int32_t a, std::int32_t b, std::int32_t c) {
    std::uint32_t h = seed * 0x9e3779b9u + 0x7f4a7c15u;
    for (std::int32_t const v : {a, b, c}) { // each round is the finaliser of MurmurHash3
        h ^= static_cast<std::uint32_t>(v) * 0xcc9e2d51u;
        h ^= h >> 16;
        h *= 0x85ebca6bu;
        h ^= h >> 13;
        h *= 0xc2b2ae35u;
        h ^= h >> 16;
    }
    return h / 4294967296.0;
}

double value_noise(std::uint32_t seed, D2 at, int period) {
    auto const wrap = [period](int i) { return period > 0 ? ((i % period) + period) % period : i; };
    int const x = static_cast<int>(std::floor(at.x));
    int const y = static_cast<int>(std::floor(at.y));
    auto const corner = [&](int i, int j) { return random_unit(seed, wrap(x + i), wrap(y + j)); };
    auto const smooth = [](double t) { return t * t * (3 - 2 * t); };
    double const u = smooth(at.x - x);
    double const v = smooth(at.y - y);
    double const low = corner(0, 0) * (1 - u) + corner(1, 0) * u;
    double const high = corner(0, 1) * (1 - u) + corner(1, 1) * u;
    return 2 * (low * (1 - v) + high * v) - 1;
}

double fractal_noise(std::uint32_t seed, D2 at, int octaves, int period, double gain) {
    double sum = 0;
    double weight = 1;
    double total = 0;
    for (int octave = 0; octave < octaves; ++octave) {
        int const scale = 1 << octave;
        sum += weight * value_noise(seed + static_cast<std::uint32_t>(octave), at * double(scale), period * scale);
        total += weight;
        weight *= gain;
    }
    return sum / total;
}

} // namespace framelet
