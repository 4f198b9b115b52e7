#include "server/render/light/light.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace framelet {
namespace {

float usable(float value, float most) {
    return value > 0 ? std::min(value, most) : 0.0f;
}

} // namespace

RenderLight make_light(Light const& light, ScenePose const& pose) {
    RenderLight out;
    out.type = light.type;
    for (int c = 0; c < 3; ++c) {
        out.intensity[c] = usable(light.color[c], 1e4f) * usable(light.intensity, 1e10f);
    }
    if (light.node >= 0 && light.node < static_cast<Index>(pose.world_from_node.size())) {
        Mat4 const& world = pose.world_from_node[static_cast<std::size_t>(light.node)];
        out.position = Vec3(world[3]);
        Vec3 const back(world[2]);
        float const length = glm::length(back);
        out.towards = length > 1e-18f && length < 1e18f ? back / length : Vec3(0, 0, 1);
        if (!traceable(out.position)) { // lights nothing that can be seen
            out.position = Vec3(0);
            out.intensity = light.type == LightType::directional ? out.intensity : Vec3(0);
        }
    }
    out.inverse_range = light.range > 0 ? 1 / light.range : 0.0f;
    float const inner = std::cos(std::clamp(light.inner_cone, 0.0f, 1.5707964f));
    float const outer = std::cos(std::clamp(light.outer_cone, 0.0f, 1.5707964f));
    out.cone_scale = 1 / std::max(0.001f, inner - outer);
    out.cone_offset = -outer * out.cone_scale;
    return out;
}

RenderLight default_sun() {
    RenderLight sun;
    sun.towards = glm::normalize(Vec3(0.5f, 0.75f, 0.45f));
    sun.intensity = Vec3(1.0f, 0.96f, 0.88f) * 2.4f;
    return sun;
}

LaneMask arriving_light(RenderLight const& light, LaneVec3 const& position, LaneVec3 const& normal, LaneMask active,
                        ArrivingLight& out) {
    if (light.type == LightType::directional) {
        out.to_light.fill(light.towards);
        out.distance.fill(INFINITY);
        for (int i = 0; i < lanes; ++i) {
            out.irradiance[i] =
                normal.x[i] * light.towards.x + normal.y[i] * light.towards.y + normal.z[i] * light.towards.z;
        }
    } else {
        Vec3 const from = light.position;
        Vec3 const axis = light.towards;
        float const scale = light.type == LightType::spot ? light.cone_scale : 0.0f;
        float const offset = light.type == LightType::spot ? light.cone_offset : 1.0f;
        float const inverse_range = light.inverse_range;
        for (int i = 0; i < lanes; ++i) {
            float x = from.x - position.x[i], y = from.y - position.y[i], z = from.z - position.z[i];
            float const squared = x * x + y * y + z * z + 1e-20f;
            float const distance = std::sqrt(squared);
            float const inverse = 1 / distance;
            x *= inverse;
            y *= inverse;
            z *= inverse;
            out.to_light.x[i] = x;
            out.to_light.y[i] = y;
            out.to_light.z[i] = z;
            out.distance[i] = distance;
            float const bounded = squared > lamp_core * lamp_core ? squared : lamp_core * lamp_core;
            float const reach = distance * inverse_range;
            float const window = 1 - (reach * reach) * (reach * reach);
            float const in_range = window > 0 ? window : 0.0f;
            float const cone = (x * axis.x + y * axis.y + z * axis.z) * scale + offset;
            float const in_cone = cone > 0 ? (cone < 1 ? cone : 1.0f) : 0.0f;
            float const cosine = normal.x[i] * x + normal.y[i] * y + normal.z[i] * z;
            out.irradiance[i] = cosine * in_range * in_cone * in_cone / bounded;
        }
    }
    return active & lanes_where([&](int i) { return out.irradiance[i] > 0; });
}

} // namespace framelet
