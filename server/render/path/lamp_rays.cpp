#include "server/render/path/lamp_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/render/light/luminance.h"
#include "server/render/light/sphere_sampling.h"
#include "server/render/path/lamps.h"

namespace framelet {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

} // namespace

LampRays::LampRays(std::span<RenderLight const> lights) {
    float sum = 0;
    for (std::uint32_t number = 0; number < lights.size(); ++number) {
        RenderLight const& light = lights[number];
        if (light.type == LightType::directional || !(luminance(light.intensity) > 0)) {
            continue;
        }
        bool const is_spot = light.type == LightType::spot;
        float const edge = is_spot ? std::clamp(-light.cone_offset / light.cone_scale, -1.0f, 1.0f) : -1.0f;
        lamps_.push_back({number, light.position, -light.towards, 2 * pi * (1 - edge)});
        sum += luminance(light.intensity) * lamps_.back().angle;
        up_to_.push_back(sum);
    }
    for (float& up_to : up_to_) {
        up_to /= sum;
    }
}

LampRay LampRays::sample(float choice, Vec2 way, Vec2 aside, float radius) const {
    auto const found = static_cast<std::size_t>(std::ranges::upper_bound(up_to_, choice) - up_to_.begin());
    Lamp const& lamp = lamps_[std::min(found, lamps_.size() - 1)];
    if (!(radius > 0)) {
        Vec3 const direction = sample_cone(lamp.axis, lamp.angle, way);
        return {lamp.number, lamp.position + direction * lamp_core, direction};
    }
    Vec3 const direction = sample_cone(lamp.axis, 4 * pi, way);
    float const from_axis = radius * std::sqrt(aside.x), turn = 2 * pi * aside.y;
    Vec3 const out(from_axis * std::cos(turn), from_axis * std::sin(turn),
                   std::sqrt(std::max(0.0f, radius * radius - from_axis * from_axis)));
    return {lamp.number, lamp.position + frame_about(direction) * out, direction};
}

float LampRays::density(std::uint32_t lamp, float distance, float radius) const {
    auto const found = std::ranges::lower_bound(lamps_, lamp, {}, &Lamp::number);
    if (found == lamps_.end() || found->number != lamp || distance <= std::max(radius, lamp_core)) {
        return 0;
    }
    auto const i = static_cast<std::size_t>(found - lamps_.begin());
    float const share = up_to_[i] - (i > 0 ? up_to_[i - 1] : 0.0f);
    return share / ((radius > 0 ? 4 * pi : found->angle) * distance * distance);
}

} // namespace framelet
