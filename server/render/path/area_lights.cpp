#include "server/render/path/area_lights.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/light/luminance.h"
#include "server/render/surface/hit_frame.h"

namespace framelet {
namespace {

/// Of the material's mean luminance, which every triangle counts as well: none that shines anywhere is left out.
constexpr float least_share = 0.02f;

bool shines(RenderMaterial const& material) {
    return luminance(material.emissive) > 0 && !material.unlit;
}

/// Emission as the triangle has it in the mean, by one filtered look-up.
float estimated_luminance(Geometry const& geometry, std::uint32_t triangle) {
    RenderMaterial const& material = *geometry.material;
    if (!material.emissive_map) {
        return luminance(material.emissive);
    }
    std::vector<Vec2> const& uv = geometry.source->uv[static_cast<std::size_t>(material.emissive_map.uv_set())];
    UvFootprint const everything{Vec2(1e4f, 0), Vec2(0, 1e4f)};
    Vec3 mean(material.emissive_map.sample(Vec2(0), everything));
    Vec3 here = mean;
    if (!uv.empty()) {
        TrianglePoint const middle = point_of(geometry, triangle, 1.0f / 3, 1.0f / 3);
        UvFootprint const covered{0.7f * (uv[middle.corner[1]] - uv[middle.corner[0]]),
                                  0.7f * (uv[middle.corner[2]] - uv[middle.corner[0]])};
        here = Vec3(material.emissive_map.sample(middle.interpolate(uv), covered));
    }
    return luminance(material.emissive * (here + mean * least_share));
}

struct Corners {
    Vec3 first, edge1, edge2; ///< world
};

Corners corners_of(Instance const& instance, Geometry const& geometry, std::uint32_t triangle) {
    auto const& corner = geometry.source->triangles[triangle];
    Vec3 const a = geometry.positions[corner[0]];
    return {instance.linear * a + instance.translation, instance.linear * (geometry.positions[corner[1]] - a),
            instance.linear * (geometry.positions[corner[2]] - a)};
}

Vec3 emission_at(Geometry const& geometry, std::uint32_t triangle, float u, float v) {
    RenderMaterial const& material = *geometry.material;
    Vec3 emissive = material.emissive;
    if (material.emissive_map) {
        std::vector<Vec2> const& uv = geometry.source->uv[static_cast<std::size_t>(material.emissive_map.uv_set())];
        Vec2 const at = uv.empty() ? Vec2(0) : point_of(geometry, triangle, u, v).interpolate(uv);
        emissive *= Vec3(material.emissive_map.sample(at, {}));
    }
    if (material.alpha_mode == AlphaMode::opaque) {
        return emissive;
    }
    float const alpha = alpha_at(geometry, triangle, u, v);
    if (material.alpha_mode == AlphaMode::mask) {
        return alpha < material.alpha_cutoff ? Vec3(0) : emissive;
    }
    return emissive * std::clamp(alpha, 0.0f, 1.0f);
}

} // namespace

AreaLights::AreaLights(PreparedScene const& scene) {
    std::vector<double> sums;
    for (Instance const& instance : scene.instances) {
        for (Geometry const& geometry : instance.geometries) {
            if (!shines(*geometry.material)) {
                continue;
            }
            for (std::uint32_t i = 0; i < geometry.source->triangles.size(); ++i) {
                Corners const c = corners_of(instance, geometry, i);
                double const area = 0.5 * double(glm::length(glm::cross(c.edge1, c.edge2)));
                double const weight = area * double(estimated_luminance(geometry, i));
                if (weight > 0 && std::isfinite(weight)) {
                    total_ += weight;
                    triangles_.push_back({&instance, &geometry, i});
                    sums.push_back(total_);
                }
            }
        }
    }
    for (double const sum : sums) {
        up_to_.push_back(static_cast<float>(sum / total_));
    }
}

LightPoint AreaLights::sample(float choice, Vec2 random) const {
    auto const found = std::ranges::upper_bound(up_to_, choice);
    std::size_t const last = triangles_.size() - 1;
    Triangle const& t = triangles_[std::min(static_cast<std::size_t>(found - up_to_.begin()), last)];
    float const root = std::sqrt(random.x);
    float const u = root * (1 - random.y), v = root * random.y;
    Corners const c = corners_of(*t.instance, *t.geometry, t.number);
    Vec3 const normal = unit_or(glm::cross(c.edge1, c.edge2) * t.instance->handedness, Vec3(0));
    return {c.first + c.edge1 * u + c.edge2 * v, normal, t.geometry->material->double_sided,
            emission_at(*t.geometry, t.number, u, v), density(*t.geometry, t.number)};
}

float AreaLights::density(Geometry const& geometry, std::uint32_t triangle) const {
    return shines(*geometry.material) && !empty()
               ? static_cast<float>(double(estimated_luminance(geometry, triangle)) / total_)
               : 0.0f;
}

} // namespace framelet
