#include "server/render/surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

/// Corners of the triangle that was hit, and the weights of its point.
struct TrianglePoint {
    std::array<std::uint32_t, 3> corner;
    float w, u, v;

    template <class T>
    T interpolate(std::span<T const> values) const {
        return values[corner[0]] * w + values[corner[1]] * u + values[corner[2]] * v;
    }
    template <class T>
    T interpolate(std::vector<T> const& values) const {
        return interpolate(std::span<T const>(values));
    }
};

TrianglePoint point_of(Geometry const& geometry, std::uint32_t triangle, float u, float v) {
    return {geometry.source->triangles[triangle], 1 - u - v, u, v};
}

Vec2 uv_of(Geometry const& geometry, TrianglePoint const& point, int set) {
    std::vector<Vec2> const& uv = geometry.source->uv[static_cast<std::size_t>(set)];
    return uv.empty() ? Vec2(0) : point.interpolate(uv);
}

/// `value` as a unit vector, or `instead` where it has no direction.
Vec3 unit_or(Vec3 const& value, Vec3 const& instead) {
    float const squared = glm::dot(value, value);
    return squared > 1e-30f && squared < 1e30f ? value * (1 / std::sqrt(squared)) : instead;
}

/// The world-space frame of the triangle that was hit.
struct Facet {
    Vec3 edge1, edge2; ///< from the first corner
    Vec3 normal; ///< unit, on the viewer's side
    Vec3 ray; ///< unit direction of the ray
    float width; ///< of the sample's cone there
    float inverse_determinant; ///< of the edges' Gram matrix; 0 for slivers
};

/// Texture coordinates covered by the sample: the cone's cross-section projected along the ray onto the facet.
UvFootprint uv_footprint(Facet const& facet, Geometry const& geometry, TrianglePoint const& point, int set) {
    std::vector<Vec2> const& uv = geometry.source->uv[static_cast<std::size_t>(set)];
    if (uv.empty() || facet.inverse_determinant == 0) {
        return {};
    }
    float const cosine = std::max(std::abs(glm::dot(facet.ray, facet.normal)), 0.02f);
    Vec3 const along = unit_or(facet.ray - facet.normal * glm::dot(facet.ray, facet.normal),
                               unit_or(facet.edge1, Vec3(1, 0, 0)));
    Vec3 const major = along * (facet.width / cosine);
    Vec3 const minor = glm::cross(facet.normal, along) * facet.width;
    Vec2 const uv1 = uv[point.corner[1]] - uv[point.corner[0]];
    Vec2 const uv2 = uv[point.corner[2]] - uv[point.corner[0]];
    float const a = glm::dot(facet.edge1, facet.edge1);
    float const b = glm::dot(facet.edge1, facet.edge2);
    float const c = glm::dot(facet.edge2, facet.edge2);
    auto in_uv = [&](Vec3 const& step) {
        float const x = glm::dot(step, facet.edge1);
        float const y = glm::dot(step, facet.edge2);
        Vec2 const step_uv = (uv1 * (c * x - b * y) + uv2 * (a * y - b * x)) * facet.inverse_determinant;
        // Slivers and wild coordinates: whatever cannot be told apart any more counts as covering everything.
        bool const sane = std::abs(step_uv.x) < 1e4f && std::abs(step_uv.y) < 1e4f;
        return sane ? step_uv : Vec2(1e4f);
    };
    return {in_uv(major), in_uv(minor)};
}

/// Where a smooth mesh would be: the point moved out onto the mean of its corners' tangent planes (Hanika, "Hacking
/// the shadow terminator", Ray Tracing Gems II, 2021). Facets then do not shadow themselves along the terminator.
/// Corner normals far off the facet's own (foliage, flat signs) say nothing about its shape and move nothing.
Vec3 smooth_offset(Geometry const& geometry, Instance const& instance, TrianglePoint const& point, Vec3 const& at,
                   Facet const& facet) {
    if (geometry.normals.empty()) {
        return Vec3(0);
    }
    Vec3 const object_normal = glm::transpose(instance.linear) * facet.normal;
    float const weights[3] = {point.w, point.u, point.v};
    Vec3 offset(0);
    for (std::size_t i = 0; i < 3; ++i) {
        Vec3 n = geometry.normals[point.corner[i]];
        float const agreement = glm::dot(n, object_normal);
        float const limit = 0.5f * glm::length(object_normal) * glm::length(n);
        if (!(std::abs(agreement) > limit)) {
            return Vec3(0);
        }
        n = agreement < 0 ? -n : n;
        float const below = std::min(0.0f, glm::dot(at - geometry.positions[point.corner[i]], n));
        offset -= n * (below * weights[i]);
    }
    return instance.linear * offset;
}

/// Shading normal in world space, before facing the viewer.
Vec3 mapped_normal(Geometry const& geometry, Instance const& instance, TrianglePoint const& point, Facet const& facet,
                   Vec3 const& front, Vec2 uv, UvFootprint const& footprint) {
    if (geometry.normals.empty()) {
        return front;
    }
    Vec3 const object_normal = point.interpolate(geometry.normals);
    Vec3 const normal = unit_or(instance.normal_matrix * object_normal, front);
    RenderMaterial const& material = *geometry.material;
    if (!material.normal_map) {
        return normal;
    }
    Vec3 tangent, bitangent;
    if (!geometry.tangents.empty()) {
        // The bitangent belongs to the mesh's own space, so that a mirrored instance shows mirrored bumps.
        Vec4 const t = point.interpolate(geometry.tangents);
        tangent = instance.linear * Vec3(t);
        bitangent = instance.linear * (glm::cross(object_normal, Vec3(t)) * (t.w < 0 ? -1.0f : 1.0f));
    } else {
        std::vector<Vec2> const& set = geometry.source->uv[static_cast<std::size_t>(material.normal_map.uv_set())];
        if (set.empty()) {
            return normal;
        }
        Vec2 const uv1 = set[point.corner[1]] - set[point.corner[0]];
        Vec2 const uv2 = set[point.corner[2]] - set[point.corner[0]];
        float const turn = uv1.x * uv2.y - uv2.x * uv1.y < 0 ? -1.0f : 1.0f;
        tangent = (facet.edge1 * uv2.y - facet.edge2 * uv1.y) * turn;
        bitangent = (facet.edge1 * uv2.x - facet.edge2 * uv1.x) * turn; // against v, which points down
    }
    tangent = unit_or(tangent - normal * glm::dot(normal, tangent), Vec3(0));
    bitangent = unit_or(bitangent - normal * glm::dot(normal, bitangent), Vec3(0));
    Vec4 const texel = material.normal_map.sample(uv, footprint);
    Vec3 const bump = Vec3(texel) * 2.0f - 1.0f;
    return unit_or(tangent * (bump.x * material.normal_scale) + bitangent * (bump.y * material.normal_scale) +
                       normal * bump.z,
                   normal);
}

/// Turns `normal` just far enough towards the viewer to lie above the surface's horizon.
Vec3 facing(Vec3 const& normal, Vec3 const& view) {
    constexpr float least = 0.01f;
    float const cosine = glm::dot(normal, view);
    return cosine >= least ? normal : unit_or(normal + view * (least - cosine), view);
}

float cut_or_blend_alpha(RenderMaterial const& material, float alpha) {
    return material.alpha_mode == AlphaMode::blend ? std::clamp(alpha, 0.0f, 1.0f) : 1.0f;
}

void set_material(Geometry const& geometry, TrianglePoint const& point, int lane,
                  std::array<Vec2, 2> const& uv, std::array<UvFootprint, 2> const& footprint, SurfacePacket& out) {
    RenderMaterial const& m = *geometry.material;
    auto look_up = [&](TextureSampler const& map) {
        std::size_t const set = static_cast<std::size_t>(map.uv_set());
        return map.sample(uv[set], footprint[set]);
    };
    Vec4 base = m.base_color;
    if (!geometry.source->colors.empty()) {
        base *= glm::clamp(point.interpolate(geometry.source->colors), Vec4(0), Vec4(1));
    }
    if (m.base_color_map) {
        base *= look_up(m.base_color_map);
    }
    float metallic = m.metallic, roughness = m.roughness, occlusion = 1, transmission = m.transmission;
    if (m.metallic_roughness_map) {
        Vec4 const texel = look_up(m.metallic_roughness_map);
        roughness *= texel.g;
        metallic *= texel.b;
        if (m.occlusion_in_roughness_map) {
            occlusion = texel.r;
        }
    }
    if (m.occlusion_map && !m.occlusion_in_roughness_map) {
        occlusion = look_up(m.occlusion_map).r;
    }
    Vec3 emissive = m.emissive;
    if (m.emissive_map) {
        emissive *= Vec3(look_up(m.emissive_map));
    }
    if (m.transmission_map) {
        transmission *= look_up(m.transmission_map).r;
    }
    out.base_color.set(lane, Vec3(base));
    out.alpha[lane] = cut_or_blend_alpha(m, base.a);
    out.emissive.set(lane, emissive);
    out.metallic[lane] = metallic;
    out.roughness[lane] = roughness;
    out.occlusion[lane] = 1 + m.occlusion_strength * (occlusion - 1);
    out.transmission[lane] = transmission * (1 - metallic);
    out.unlit |= static_cast<LaneMask>(m.unlit ? 1u : 0u) << lane;
}

} // namespace

float alpha_at(Geometry const& geometry, std::uint32_t triangle, float u, float v) {
    RenderMaterial const& material = *geometry.material;
    TrianglePoint const point = point_of(geometry, triangle, u, v);
    float alpha = material.base_color.a;
    if (!geometry.source->colors.empty()) {
        alpha *= point.interpolate(geometry.source->colors).a;
    }
    if (material.base_color_map) {
        alpha *= material.base_color_map.alpha(uv_of(geometry, point, material.base_color_map.uv_set()));
    }
    return alpha;
}

Vec3 transmittance_at(Geometry const& geometry, std::uint32_t triangle, float u, float v) {
    RenderMaterial const& material = *geometry.material;
    float const alpha = alpha_at(geometry, triangle, u, v);
    if (material.alpha_mode == AlphaMode::mask && alpha < material.alpha_cutoff) {
        return Vec3(1);
    }
    float const presence = cut_or_blend_alpha(material, alpha);
    if (!(material.transmission > 0)) {
        return Vec3(1 - presence);
    }
    TrianglePoint const point = point_of(geometry, triangle, u, v);
    Vec3 tint = material.base_color;
    if (material.base_color_map) {
        tint *= Vec3(material.base_color_map.sample(uv_of(geometry, point, material.base_color_map.uv_set()), {}));
    }
    float transmission = material.transmission * (1 - material.metallic);
    if (material.transmission_map) {
        transmission *= material.transmission_map.sample(
            uv_of(geometry, point, material.transmission_map.uv_set()), {}).r;
    }
    return Vec3(1 - presence) + tint * (presence * transmission * 0.96f); // 4% are reflected
}

Vec3 offset_from_surface(Vec3 const& position, Vec3 const& normal) {
    constexpr float near_origin = 1.0f / 32.0f;
    constexpr float float_scale = 1.0f / 65536.0f;
    constexpr float int_scale = 256.0f;
    Vec3 out;
    for (int c = 0; c < 3; ++c) {
        int const steps = static_cast<int>(int_scale * normal[c]);
        std::int32_t const bits = std::bit_cast<std::int32_t>(position[c]);
        float const moved = std::bit_cast<float>(bits + (position[c] < 0 ? -steps : steps));
        out[c] = std::abs(position[c]) < near_origin ? position[c] + float_scale * normal[c] : moved;
    }
    return out;
}

LaneMask make_surfaces(std::span<Instance const> instances, RayPacket const& rays, HitPacket const& hits, LaneMask hit,
                       Footprint const& footprint, SurfacePacket& out) {
    LaneMask present = 0;
    out.unlit = 0;
    for_each_lane(hit, [&](int lane) {
        Instance const& instance = instances[hits.instance[lane]];
        Geometry const& geometry = instance.geometries[hits.geometry[lane]];
        RenderMaterial const& material = *geometry.material;
        TrianglePoint const point = point_of(geometry, hits.triangle[lane], hits.u[lane], hits.v[lane]);

        Vec3 const corner = geometry.positions[point.corner[0]];
        Vec3 const object_edge1 = geometry.positions[point.corner[1]] - corner;
        Vec3 const object_edge2 = geometry.positions[point.corner[2]] - corner;
        Facet facet;
        facet.edge1 = instance.linear * object_edge1;
        facet.edge2 = instance.linear * object_edge2;
        Vec3 const direction = rays.direction.get(lane);
        facet.ray = unit_or(direction, Vec3(0, 0, -1));
        Vec3 const scaled_normal = glm::cross(facet.edge1, facet.edge2) * instance.handedness;
        float const squared = glm::dot(scaled_normal, scaled_normal);
        facet.inverse_determinant = squared > 1e-30f ? 1 / squared : 0;
        Vec3 const front = unit_or(scaled_normal, -facet.ray);
        bool const behind = glm::dot(front, facet.ray) > 0;
        Vec3 const in_object = corner + object_edge1 * point.u + object_edge2 * point.v;
        Vec3 const position = instance.linear * in_object + instance.translation;
        if ((behind && !material.double_sided) || !traceable(position)) {
            return;
        }
        present |= 1u << lane;
        facet.normal = behind ? -front : front;
        facet.width = footprint.width[lane] + footprint.slope[lane] * hits.t[lane];

        std::array<Vec2, 2> uv{};
        std::array<UvFootprint, 2> covered;
        if (material.uses_uv()) {
            for (int set = 0; set < 2; ++set) {
                if (!geometry.source->uv[static_cast<std::size_t>(set)].empty()) {
                    uv[static_cast<std::size_t>(set)] = uv_of(geometry, point, set);
                    covered[static_cast<std::size_t>(set)] = uv_footprint(facet, geometry, point, set);
                }
            }
        }
        std::size_t const normal_set = material.normal_map ? static_cast<std::size_t>(material.normal_map.uv_set()) : 0;
        Vec3 normal = mapped_normal(geometry, instance, point, facet, front, uv[normal_set], covered[normal_set]);
        normal = behind ? -normal : normal;

        Vec3 const smooth = position + smooth_offset(geometry, instance, point, in_object, facet);
        out.position.set(lane, position);
        out.leaving.set(lane, offset_from_surface(traceable(smooth) ? smooth : position, facet.normal));
        out.geometric_normal.set(lane, facet.normal);
        out.view.set(lane, -facet.ray);
        out.width[lane] = facet.width;
        out.spread[lane] = footprint.slope[lane] / std::max(glm::length(direction), 1e-20f);
        out.normal.set(lane, facing(normal, -facet.ray));
        set_material(geometry, point, lane, uv, covered, out);
    });
    return present;
}

} // namespace framelet
