#include "server/render/light/octahedral_map.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "common/error.h"

namespace framelet {
namespace {

float sign_of(float x) {
    return x < 0 ? -1.0f : 1.0f;
}

} // namespace

Vec2 octahedral_from_direction(Vec3 const& d) {
    float const sum = std::max(std::abs(d.x) + std::abs(d.y) + std::abs(d.z), 1e-30f);
    float x = d.x / sum;
    float z = d.z / sum;
    if (d.y < 0) {
        float const folded = (1 - std::abs(z)) * sign_of(x);
        z = (1 - std::abs(x)) * sign_of(z);
        x = folded;
    }
    return {0.5f * x + 0.5f, 0.5f * z + 0.5f};
}

Vec3 direction_from_octahedral(Vec2 point) {
    float x = 2 * point.x - 1;
    float z = 2 * point.y - 1;
    float const y = 1 - std::abs(x) - std::abs(z);
    if (y < 0) {
        float const unfolded = (1 - std::abs(z)) * sign_of(x);
        z = (1 - std::abs(x)) * sign_of(z);
        x = unfolded;
    }
    return glm::normalize(Vec3(x, y, z));
}

std::vector<Vec3> octahedral_directions(int side) {
    std::vector<Vec3> directions;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            Vec2 const center(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f);
            directions.push_back(direction_from_octahedral(center / static_cast<float>(side)));
        }
    }
    return directions;
}

OctahedralMap::OctahedralMap(int side, std::vector<Vec3> const& values) : side_(side) {
    FRAMELET_CHECK(values.size() == static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int j = -1; j <= side; ++j) {
        for (int i = -1; i <= side; ++i) {
            // Across an edge the map goes on mirrored about the edge's middle.
            int x = i, y = j;
            if (x < 0 || x >= side) {
                x = std::clamp(x, 0, side - 1);
                y = side - 1 - y;
            }
            if (y < 0 || y >= side) {
                y = std::clamp(y, 0, side - 1);
                x = side - 1 - x;
            }
            Vec3 const value =
                values[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)];
            texels_.emplace_back(value, 0.0f);
        }
    }
}

Vec3 OctahedralMap::sample_at(Vec2 point) const {
    float const x = std::clamp(point.x, 0.0f, 1.0f) * static_cast<float>(side_) + 0.5f; // of the bordered picture
    float const y = std::clamp(point.y, 0.0f, 1.0f) * static_cast<float>(side_) + 0.5f;
    int const i = static_cast<int>(x);
    int const j = static_cast<int>(y);
    float const s = x - static_cast<float>(i);
    float const t = y - static_cast<float>(j);
    std::size_t const stride = static_cast<std::size_t>(side_) + 2;
    Vec4 const* texel = &texels_[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)];
    Vec4 const upper = texel[0] + (texel[1] - texel[0]) * s;
    Vec4 const lower = texel[stride] + (texel[stride + 1] - texel[stride]) * s;
    return Vec3(upper + (lower - upper) * t);
}

} // namespace framelet
