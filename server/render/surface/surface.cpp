#include "server/render/surface/surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/surface/hit_frame.h"

namespace framelet {
namespace {

Vec2 uv_of(Geometry const& geometry, TrianglePoint const& point, int set) {
    std::vector<Vec2> const& uv = geometry.source->uv[static_cast<std::size_t>(set)];
    return uv.empty() ? Vec2(0) : point.interpolate(uv);
}

/// Texture coordinates covered by the sample: the cone's cross-section projected along the ray onto the facet.
UvFootprint uv_footprint(HitFrame const& frame, int lane, float width, std::vector<Vec2> const& uv) {
    float const inverse_determinant = frame.inverse_determinant[lane];
    if (inverse_determinant == 0) {
        return {};
    }
    TrianglePoint const& point = frame.point[static_cast<std::size_t>(lane)];
    Vec3 const ray = frame.ray.get(lane), facet = frame.facet.get(lane);
    Vec3 const edge1 = frame.edge1.get(lane), edge2 = frame.edge2.get(lane);
    float const cosine = -glm::dot(ray, facet);
    Vec3 const flat = ray + facet * cosine;
    float const sine_squared = glm::dot(flat, flat);
    Vec3 const along = sine_squared > 1e-8f ? flat * (1 / std::sqrt(sine_squared)) : unit_or(edge1, Vec3(1, 0, 0));
    Vec3 const major = along * (width / std::max(cosine, 0.02f));
    Vec3 const minor = glm::cross(facet, along) * width;
    Vec2 const uv1 = uv[point.corner[1]] - uv[point.corner[0]];
    Vec2 const uv2 = uv[point.corner[2]] - uv[point.corner[0]];
    float const a = glm::dot(edge1, edge1);
    float const b = glm::dot(edge1, edge2);
    float const c = glm::dot(edge2, edge2);
    auto in_uv = [&](Vec3 const& step) {
        float const x = glm::dot(step, edge1);
        float const y = glm::dot(step, edge2);
        Vec2 const step_uv = (uv1 * (c * x - b * y) + uv2 * (a * y - b * x)) * inverse_determinant;
        // Slivers and wild coordinates: whatever cannot be told apart any more counts as covering everything.
        bool const sane = std::abs(step_uv.x) < 1e4f && std::abs(step_uv.y) < 1e4f;
        return sane ? step_uv : Vec2(1e4f);
    };
    return {in_uv(major), in_uv(minor)};
}

/// Shading normal from a normal map, before facing the viewer.
Vec3 mapped_normal(HitFrame const& frame, int lane, Vec2 uv, UvFootprint const& footprint) {
    std::size_t const i = static_cast<std::size_t>(lane);
    Geometry const& geometry = *frame.geometry[i];
    TrianglePoint const& point = frame.point[i];
    RenderMaterial const& material = *geometry.material;
    Vec3 const normal = frame.normal.get(lane);
    Vec3 tangent, bitangent;
    if (!geometry.tangents.empty() && !geometry.normals.empty()) {
        // The bitangent belongs to the mesh's own space, so that a mirrored instance shows mirrored bumps.
        Vec4 const t = point.interpolate(geometry.tangents);
        Mat3 const& linear = frame.instance[i]->linear;
        tangent = linear * Vec3(t);
        bitangent = linear * (glm::cross(point.interpolate(geometry.normals), Vec3(t)) * (t.w < 0 ? -1.0f : 1.0f));
    } else {
        std::vector<Vec2> const& set = geometry.source->uv[static_cast<std::size_t>(material.normal_map.uv_set())];
        if (set.empty()) {
            return normal;
        }
        Vec2 const uv1 = set[point.corner[1]] - set[point.corner[0]];
        Vec2 const uv2 = set[point.corner[2]] - set[point.corner[0]];
        float const turn = uv1.x * uv2.y - uv2.x * uv1.y < 0 ? -1.0f : 1.0f;
        Vec3 const edge1 = frame.edge1.get(lane), edge2 = frame.edge2.get(lane);
        tangent = (edge1 * uv2.y - edge2 * uv1.y) * turn;
        bitangent = (edge1 * uv2.x - edge2 * uv1.x) * turn; // against v, which points down
    }
    tangent = unit_or(tangent - normal * glm::dot(normal, tangent), Vec3(0));
    bitangent = unit_or(bitangent - normal * glm::dot(normal, bitangent), Vec3(0));
    Vec3 const bump = Vec3(material.normal_map.sample(uv, footprint)) * 2.0f - 1.0f;
    return unit_or(tangent * (bump.x * material.normal_scale) + bitangent * (bump.y * material.normal_scale) +
                       normal * bump.z,
                   normal);
}

/// Turns normals to the viewer's side, and just far enough towards the viewer to lie above the surface's horizon.
void face_viewer(LaneVec3 const& ray, LaneMask behind, LaneVec3& normal) {
    constexpr float least = 0.01f;
    for (int i = 0; i < lanes; ++i) {
        float const sign = (behind >> i & 1) != 0 ? -1.0f : 1.0f;
        float const x = normal.x[i] * sign, y = normal.y[i] * sign, z = normal.z[i] * sign;
        float const cosine = -(x * ray.x[i] + y * ray.y[i] + z * ray.z[i]);
        float const turn = cosine < least ? least - cosine : 0.0f;
        float const bx = x - ray.x[i] * turn, by = y - ray.y[i] * turn, bz = z - ray.z[i] * turn;
        // Turned straight away from the viewer the sum is short, but never shorter than `least`.
        float const scale = 1 / std::sqrt(bx * bx + by * by + bz * bz);
        normal.x[i] = bx * scale;
        normal.y[i] = by * scale;
        normal.z[i] = bz * scale;
    }
}

float largest_of(Vec3 const& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

float cut_or_blend_alpha(RenderMaterial const& material, float alpha) {
    return material.alpha_mode == AlphaMode::blend ? std::clamp(alpha, 0.0f, 1.0f) : 1.0f;
}

/// A point's texture coordinates in both sets, and what the sample covers of them.
struct TexturePoint {
    std::array<Vec2, 2> uv{};
    std::array<UvFootprint, 2> footprint{};
};

TexturePoint texture_point(HitFrame const& frame, int lane, float width) {
    std::size_t const i = static_cast<std::size_t>(lane);
    TexturePoint uv_point;
    for (std::size_t set = 0; set < 2; ++set) {
        std::vector<Vec2> const& uv = frame.geometry[i]->source->uv[set];
        if (!uv.empty()) {
            uv_point.uv[set] = frame.point[i].interpolate(uv);
            uv_point.footprint[set] = uv_footprint(frame, lane, width, uv);
        }
    }
    return uv_point;
}

void set_material(Geometry const& geometry, TrianglePoint const& point, int lane, TexturePoint const& uv_point,
                  SurfacePacket& out) {
    RenderMaterial const& m = *geometry.material;
    auto look_up = [&](TextureSampler const& map) {
        std::size_t const set = static_cast<std::size_t>(map.uv_set());
        return map.sample(uv_point.uv[set], uv_point.footprint[set]);
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
        transmission *=
            material.transmission_map.sample(uv_of(geometry, point, material.transmission_map.uv_set()), {}).r;
    }
    return Vec3(1 - presence) + tint * (presence * transmission * entering_share);
}

Vec3 offset_from_surface(Vec3 const& position, Vec3 const& normal, float largest) {
    float const near_origin = std::min(largest, 1.0f / 32.0f);
    float const float_scale = near_origin / 2048.0f;
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
    HitFrame frame{};
    LaneMask const present = make_hit_frames(instances, rays, hits, hit, frame);
    for (int i = 0; i < lanes; ++i) {
        float const x = rays.direction.x[i], y = rays.direction.y[i], z = rays.direction.z[i];
        float const squared = x * x + y * y + z * z;
        out.width[i] = footprint.width[i] + footprint.slope[i] * hits.t[i];
        out.spread[i] = footprint.slope[i] / std::sqrt(squared > 1e-30f ? squared : 1e-30f);
        out.view.x[i] = -frame.ray.x[i];
        out.view.y[i] = -frame.ray.y[i];
        out.view.z[i] = -frame.ray.z[i];
    }
    out.position = frame.position;
    out.geometric_normal = frame.facet;
    out.normal = frame.normal;
    out.unlit = 0;
    for_each_lane(present, [&](int lane) {
        std::size_t const i = static_cast<std::size_t>(lane);
        Geometry const& geometry = *frame.geometry[i];
        RenderMaterial const& material = *geometry.material;
        TexturePoint const uv_point = material.uses_uv ? texture_point(frame, lane, out.width[lane]) : TexturePoint{};
        if (material.normal_map) {
            std::size_t const set = static_cast<std::size_t>(material.normal_map.uv_set());
            out.normal.set(lane, mapped_normal(frame, lane, uv_point.uv[set], uv_point.footprint[set]));
        }
        set_material(geometry, frame.point[i], lane, uv_point, out);
        Vec3 const position = frame.position.get(lane);
        Vec3 const smooth = position + smooth_offset(frame, lane);
        float const largest = std::max({largest_of(position), largest_of(frame.edge1.get(lane)),
                                        largest_of(frame.edge2.get(lane)), largest_of(frame.instance[i]->translation)});
        out.leaving.set(lane,
                        offset_from_surface(traceable(smooth) ? smooth : position, frame.facet.get(lane), largest));
    });
    face_viewer(frame.ray, frame.behind, out.normal);
    return present;
}

} // namespace framelet
