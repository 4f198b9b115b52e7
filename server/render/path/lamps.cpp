#include "server/render/path/lamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "server/render/light/luminance.h"
#include "server/render/light/sphere_sampling.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

} // namespace

float LampShine::angle() const {
    return cone_angle(sine);
}

Vec3 LampShine::radiance() const {
    return arriving / (pi * sine * sine);
}

float LampShine::met_at(Vec3 const& direction) const {
    float const along = glm::dot(direction, to_light);
    Vec3 const aside = direction - to_light * along;
    float const aside_squared = glm::dot(aside, aside);
    if (!(along > 0 && aside_squared < sine * sine)) {
        return -1;
    }
    return distance * (along - std::sqrt(sine * sine - aside_squared));
}

LampShine shine_of(RenderLight const& light, LampSizes sizes, Vec3 const& position, Vec3 const& normal) {
    LaneVec3 at, facing;
    at.fill(position);
    bool const is_sun = light.type == LightType::directional;
    LampShine shine;
    Vec3 const there = light.position - position;
    shine.distance = is_sun ? INFINITY : glm::length(there);
    shine.to_light = is_sun ? light.towards : there / std::max(shine.distance, 1e-10f);
    facing.fill(shine.to_light);
    ArrivingLight arriving;
    bool const reached = arriving_light(light, at, facing, 1, arriving) != 0;
    shine.arriving = reached ? light.intensity * arriving.irradiance[0] : Vec3(0);
    shine.sine = is_sun ? std::sin(sizes.sun) : sizes.lamp / std::max(shine.distance, 1e-10f);
    if (shine.sine >= 1) { // inside it is a point, no brighter than at its surface
        shine.arriving /= shine.sine * shine.sine;
        shine.sine = 0;
    }
    float const cosine = std::min(glm::dot(normal, shine.to_light) + shine.sine, 1.0f);
    shine.weight = cosine > 0 ? luminance(shine.arriving) * cosine : 0.0f;
    return shine;
}

float shine_of_lamps(std::span<RenderLight const> lights, LampSizes sizes, Vec3 const& position, Vec3 const& normal,
                     std::vector<LampShine>& out) {
    out.clear();
    float sum = 0;
    for (RenderLight const& light : lights) {
        out.push_back(shine_of(light, sizes, position, normal));
        sum += out.back().weight;
    }
    return sum;
}

Vec3 sample_lamp(LampShine const& lamp, Vec2 random) {
    return sample_cone(lamp.to_light, lamp.angle(), random);
}

} // namespace framelet
