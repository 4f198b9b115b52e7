// Values that the generator computes with: double-precision vectors, placed meshes, repeatable noise. They are rounded
// to float only when written, so that the files come out the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/math.h"

namespace framelet {

using D2 = glm::dvec2;
using D3 = glm::dvec3;
using D4 = glm::dvec4;
using DQuat = glm::dquat;

inline constexpr double pi = 3.14159265358979323846;

constexpr double radians(double degrees) {
    return degrees * pi / 180;
}

/// Joints of a skin that move a vertex, and how much each does; weights sum to 1.
struct JointWeights {
    std::array<int, 4> joints{};
    std::array<double, 4> weights{};
};

/// A triangle list. `uv`, `colors` (linear) and `joint_weights` are empty or have one entry a vertex.
struct MeshData {
    std::vector<D3> positions, normals;
    std::vector<D2> uv;
    std::vector<D3> colors;
    std::vector<JointWeights> joint_weights;
    std::vector<std::uint32_t> indices;
};

/// Translation, rotation and scale, applied as T * R * S.
struct Placement {
    D3 translation{0, 0, 0};
    DQuat rotation{1, 0, 0, 0};
    D3 scale{1, 1, 1};
};

/// 0 up to t = 0, 1 from t = 1 on, without a bend between.
double smooth_step(double t);

/// Rotation by `angle` radians about a unit axis.
DQuat rotation_about(D3 axis, double angle);
/// The rotation that turns a camera (looking down -Z, +Y up) at `eye` towards `target`.
DQuat looking_at(D3 eye, D3 target);

/// Adds `part`, moved to `place`. Both have texture coordinates or neither has; the same for colours and joints.
void append(MeshData& mesh, MeshData const& part, Placement const& place = {});

/// A number, uniform in [0, 1), that is the same for the same arguments everywhere.
double random_unit(std::uint32_t seed, std::int32_t a, std::int32_t b = 0, std::int32_t c = 0);
/// Smooth noise in [-1, 1] with lattice spacing 1; repeats every `period` lattice cells where that is above 0.
double value_noise(std::uint32_t seed, D2 at, int period = 0);
/// `octaves` of value_noise, each twice as fine and `gain` times as strong, scaled to about [-1, 1].
double fractal_noise(std::uint32_t seed, D2 at, int octaves, int period = 0, double gain = 0.5);

} // namespace framelet
