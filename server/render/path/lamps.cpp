#include "server/render/path/lamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "server/render/light/sphere_sampling.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

} // namespace

float LampShine::angle() const {
    float const cosine = std::sqrt(std::max(0.0f, 1 - sine * sine));
    return 2 * pi * sine * sine / (1 + cosine); // 1 - cos without its loss of digits
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

float shine_of_lamps(std::span<RenderLight const> lights, LampSizes sizes, Vec3 const& position, Vec3 const& normal,
                     std::vector<LampShine>& out) {
    out.clear();
    LaneVec3 at, facing;
    at.fill(position);
    float sum = 0;
    for (RenderLight const& light : lights) {
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
        float const strength = glm::dot(shine.arriving, Vec3(0.2126f, 0.7152f, 0.0722f));
        shine.weight = cosine > 0 ? strength * cosine : 0.0f;
        sum += shine.weight;
        out.push_back(shine);
    }
    return sum;
}

Vec3 sample_lamp(LampShine const& lamp, Vec2 random) {
    float const lowered = random.x * lamp.angle() / (2 * pi); // 1 - cosine
    float const sine = std::sqrt(std::max(0.0f, lowered * (2 - lowered)));
    float const phi = 2 * pi * random.y;
    return frame_about(lamp.to_light) * Vec3(sine * std::cos(phi), sine * std::sin(phi), 1 - lowered);
}

} // namespace framelet
