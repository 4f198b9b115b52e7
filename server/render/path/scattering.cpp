#include "server/render/path/scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "server/render/light/luminance.h"
#include "server/render/light/sphere_sampling.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
/// Below it the lobe is narrower than single precision resolves; no picture shows the difference to a mirror.
constexpr float least_roughness = 0.04f;
/// Each lobe that is there gets at least this share of the samples: the other's estimate of light stays bounded.
constexpr float least_chance = 0.1f;

float ggx_distribution(Vec3 const& half, float a2) {
    float const spread = (half.x * half.x + half.y * half.y) + a2 * half.z * half.z;
    return a2 / (pi * spread * spread);
}

/// A visible facet normal ([Heitz 2018]).
Vec3 sample_facet(Vec3 const& view, float alpha, Vec2 random) {
    Vec3 const v = glm::normalize(Vec3(alpha * view.x, alpha * view.y, view.z));
    float const flat = v.x * v.x + v.y * v.y;
    Vec3 const across = flat > 1e-12f ? Vec3(-v.y, v.x, 0) / std::sqrt(flat) : Vec3(1, 0, 0);
    Vec3 const along = glm::cross(v, across);
    float const radius = std::sqrt(random.x), phi = 2 * pi * random.y;
    float const x = radius * std::cos(phi);
    float const s = 0.5f * (1 + v.z);
    float const y = (1 - s) * std::sqrt(std::max(0.0f, 1 - x * x)) + s * radius * std::sin(phi);
    Vec3 const n = across * x + along * y + v * std::sqrt(std::max(0.0f, 1 - x * x - y * y));
    return glm::normalize(Vec3(alpha * n.x, alpha * n.y, std::max(1e-6f, n.z)));
}

} // namespace

Scattering scattering_of(SurfacePacket const& s, int lane, SplitSumTable const& split_sum, bool lambertian) {
    Scattering out;
    out.frame = frame_about(s.normal.get(lane));
    out.view = s.view.get(lane) * out.frame;
    out.view.z = std::max(out.view.z, 1e-3f);
    float const metallic = std::clamp(s.metallic[lane], 0.0f, 1.0f);
    float const roughness = std::clamp(s.roughness[lane], least_roughness, 1.0f);
    Vec3 const base = glm::clamp(s.base_color.get(lane), Vec3(0), Vec3(1));
    Vec3 const diffuse = base * ((1 - metallic) * (1 - std::clamp(s.transmission[lane], 0.0f, 1.0f)));
    out.alpha = roughness * roughness;
    if (lambertian) {
        out.f0 = Vec3(0);
        out.diffuse = diffuse;
        out.specular_chance = 0;
        return out;
    }
    out.f0 = Vec3(0.04f) + (base - 0.04f) * metallic;
    AmbientShares const shares = ambient_shares(split_sum.at(out.view.z, roughness), out.f0, diffuse);
    out.diffuse = glm::max(shares.diffuse, Vec3(0));
    float const specular = mean(shares.specular);
    float const other = mean(out.diffuse);
    out.specular_chance = other > 0 ? std::clamp(specular / (specular + other), least_chance, 1 - least_chance) : 1.0f;
    return out;
}

Vec3 albedo(Scattering const& scattering, SplitSumTable const& split_sum) {
    if (scattering.specular_chance == 0) {
        return scattering.diffuse;
    }
    Vec2 const factors = split_sum.at(scattering.view.z, std::sqrt(scattering.alpha));
    return scattering.f0 * factors.x + factors.y + scattering.diffuse;
}

Scattered scattered(Scattering const& s, Vec3 const& to_light, float least_alpha) {
    Vec3 const l = to_light * s.frame;
    if (!(l.z > 1e-6f)) {
        return {};
    }
    Scattered out;
    out.reflected = s.diffuse * (l.z / pi);
    out.density = (1 - s.specular_chance) * l.z / pi;
    if (s.specular_chance == 0) {
        return out;
    }
    Vec3 const sum = l + s.view;
    Vec3 const half = sum / std::max(glm::length(sum), 1e-10f);
    float const alpha = std::max(s.alpha, least_alpha);
    float const a2 = alpha * alpha;
    float const nv = s.view.z;
    float const lit_view = std::sqrt(nv * nv * (1 - a2) + a2);
    float const visibility = 0.5f / (l.z * lit_view + nv * std::sqrt(l.z * l.z * (1 - a2) + a2));
    float const distribution = ggx_distribution(half, a2);
    float const away = 1 - std::clamp(glm::dot(s.view, half), 0.0f, 1.0f);
    Vec3 const fresnel = s.f0 + (1.0f - s.f0) * ((away * away) * (away * away) * away);
    out.reflected += fresnel * (distribution * visibility * l.z);
    // Density of visible normals: G1 D / (4 n.v), of which 2 n.v / (n.v + sqrt(..)) is G1.
    out.density += s.specular_chance * distribution / (2 * (nv + lit_view));
    return out;
}

Vec3 sample_scattering(Scattering const& s, Vec2 random, float choice) {
    if (choice < s.specular_chance) {
        Vec3 const half = sample_facet(s.view, s.alpha, random);
        return glm::normalize(s.frame * (half * (2 * glm::dot(half, s.view)) - s.view));
    }
    float const radius = std::sqrt(random.x), phi = 2 * pi * random.y;
    return glm::normalize(s.frame * Vec3(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - random.x)));
}

} // namespace framelet
