#include "common/tone_inverse.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace framelet {
namespace {

constexpr float start_compression = 0.8f - 0.04f, desaturation = 0.15f;

/// The peak that the curve shows as this one.
float full_peak(float peak) {
    constexpr float d = 1 - start_compression;
    return d * d / (1 - peak) - d + start_compression;
}

/// The darkest channel that a colour of this peak can be shown with.
float least_with(float peak) {
    return peak * (1 - 1 / (desaturation * (full_peak(peak) - peak) + 1));
}

/// [Khronos 2024], solved for what goes in. Colours that are too pure to be shown so bright are shown as bright as they
/// can be.
Vec3 neutral(Vec3 color) {
    float const wanted = std::max({color.r, color.g, color.b});
    if (wanted > start_compression) {
        float const darkest = std::min({color.r, color.g, color.b});
        float peak = wanted;
        if (least_with(peak) > darkest) {
            peak = start_compression;
            for (float step = wanted - peak; step > 1e-4f; step /= 2) {
                peak += least_with(peak + step) <= darkest ? step : 0;
            }
            color *= peak / wanted;
        }
        float const grey = desaturation * (full_peak(peak) - peak) + 1;
        color = glm::max((color - peak) * grey + peak, 0.0f) * (full_peak(peak) / peak);
    }
    float const least = std::min({color.r, color.g, color.b});
    float const offset = least < 0.04f ? std::sqrt(least / 6.25f) - least : 0.04f;
    return color + offset;
}

} // namespace

Vec3 radiance_shown_as(Vec3 shown, ToneCurve curve) {
    constexpr float whitest = 0.98f;
    return curve == ToneCurve::neutral ? neutral(glm::clamp(shown, 0.0f, whitest)) : shown;
}

} // namespace framelet
