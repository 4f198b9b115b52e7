#include "server/render/light/split_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framelet {
namespace {

/// The lobe's integral over the hemisphere, by importance sampling on a regular grid.
Vec2 integrate(float nv, float roughness) {
    constexpr int rings = 24, spokes = 24;
    float const a2 = roughness * roughness * roughness * roughness;
    float const vx = std::sqrt(1 - nv * nv);
    float scale = 0, bias = 0;
    for (int i = 0; i < rings; ++i) {
        float const e = (static_cast<float>(i) + 0.5f) / rings;
        float const nh = std::sqrt((1 - e) / (1 + (a2 - 1) * e));
        float const sine = std::sqrt(std::max(0.0f, 1 - nh * nh));
        for (int j = 0; j < spokes; ++j) {
            float const phi = std::numbers::pi_v<float> * (static_cast<float>(j) + 0.5f) / spokes; // symmetric half
            float const vh = vx * sine * std::cos(phi) + nv * nh;
            float const nl = 2 * vh * nh - nv;
            if (nl <= 0 || vh <= 0) {
                continue;
            }
            float const visibility =
                0.5f / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
            float const weight = visibility * 4 * nl * vh / nh;
            float const fresnel = std::pow(1 - vh, 5.0f);
            scale += weight * (1 - fresnel);
            bias += weight * fresnel;
        }
    }
    Vec2 const sum = Vec2(scale, bias) / static_cast<float>(rings * spokes);
    return sum / std::max(1.0f, sum.x + sum.y); // the quadrature's own excess
}

} // namespace

SplitSumTable::SplitSumTable() {
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            float const nv = std::max(static_cast<float>(i) / (side - 1), 0.01f);
            float const roughness = std::max(static_cast<float>(j) / (side - 1), 0.03f);
            values_[static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i)] = integrate(nv, roughness);
        }
    }
}

Vec2 SplitSumTable::at(float normal_view, float roughness) const {
    float const x = std::clamp(normal_view, 0.0f, 1.0f) * (side - 1);
    float const y = std::clamp(roughness, 0.0f, 1.0f) * (side - 1);
    int const i = std::min(static_cast<int>(x), side - 2);
    int const j = std::min(static_cast<int>(y), side - 2);
    float const s = x - static_cast<float>(i);
    float const t = y - static_cast<float>(j);
    Vec2 const* v = &values_[static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i)];
    Vec2 const upper = v[0] + (v[1] - v[0]) * s;
    Vec2 const lower = v[side] + (v[side + 1] - v[side]) * s;
    return upper + (lower - upper) * t;
}

AmbientShares ambient_shares(Vec2 split_sum, Vec3 const& f0, Vec3 const& diffuse) {
    Vec3 const once = f0 * split_sum.x + split_sum.y;
    float const missing = 1 - (split_sum.x + split_sum.y);
    Vec3 const mean_fresnel = f0 + (1.0f - f0) / 21.0f;
    Vec3 const more = once * mean_fresnel / (1.0f - mean_fresnel * missing) * missing;
    return {once, more + diffuse * (1.0f - once - more)};
}

} // namespace framelet
