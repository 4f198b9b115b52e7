// What held samples are worth at a pixel, so that of several of one surface the best shows. In: how far apart they lie
// once moved, their age, how soon the looks of what they show fade. Out: one number.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/framelet/framelet_shape.h"

namespace framelet {

/// Finer than this nothing shows any better, pixels.
inline constexpr float finest_shown_spacing = 1.0f;

/// Samples that are farther apart than the coarsest framelet's, pixels, say too little of where their surface ends to
/// hide anything; the plane of a few that is seen from its side now may not even be one.
inline constexpr float most_hiding = 8.5f;

/// Whether samples so far apart once moved, and so far off their places at most, pixels, hide what lies behind them;
/// else they show only where nothing does that hides.
inline bool hides(float spacing, float misplaced) {
    return spacing < most_hiding && misplaced < most_hiding;
}

/// Whether they may be anywhere: then they show where nothing else does, be that nearer or farther.
inline bool is_astray(float spacing, float misplaced) {
    return !(misplaced < most_hiding && spacing < 8 * most_hiding);
}

/// By how many pixels a second (of scene time) samples become worse, as if they lay so much farther apart. 0 for code
/// 0.
inline float decorrelation_rate(DecorrelationCode code) {
    return code == 0 ? 0.0f : std::exp2(static_cast<float>(code - 128) / 8);
}

/// The nearest code of a rate >= 0; 0 for what is not a number.
inline DecorrelationCode decorrelation_code(float rate) {
    if (!(rate > std::exp2(-127.0f / 8))) {
        return 0;
    }
    return static_cast<DecorrelationCode>(std::lround(std::clamp(8 * std::log2(rate) + 128, 1.0f, 255.0f)));
}

/// The spacing, pixels, of fresh samples that would be as bad: what detail is missed grows about as the spacing does.
/// `spacing`: once moved, pixels; `age`: seconds of scene time, of either sign; `rate`: as `decorrelation_rate` has it.
inline float worn_spacing(float spacing, float age, float rate) {
    return std::max(spacing, finest_shown_spacing) + rate * std::abs(age);
}

/// Whether what is carried so is a shadow that goes over a surface, or deforms.
inline bool drifts(BodyNumber body, Vec3 const& velocity) {
    return body == static_body && velocity != Vec3(0);
}

/// For so long (seconds of scene time) what drifts is about where it was seen to go.
inline constexpr float leading_seconds = 0.2f;

/// Whether what is carried so, and lies on a layer, shows before all that it comes over, however good that is.
inline bool leads(BodyNumber body, Vec3 const& velocity, float age) {
    return drifts(body, velocity) && std::abs(age) < leading_seconds;
}

/// Whether it may have gone elsewhere since: then it shows only where nothing else does, or scraps of old shadows would
/// lie about wherever they are finer than the ground.
inline bool is_adrift(BodyNumber body, Vec3 const& velocity, float age) {
    return drifts(body, velocity) && !leads(body, velocity, age);
}

/// Steps of a worn spacing, of a float's mantissa: 1/4 within each octave.
inline constexpr std::uint32_t worn_step_bits = 1u << 21;
/// What is worn more is no worse.
inline constexpr float worst_worn = 1e3f;

/// In steps, so that what is about as good does not change places from picture to picture. What is not a number is as
/// bad as can be.
inline float worn_step(float worn) {
    auto const bits = std::bit_cast<std::uint32_t>(worn < worst_worn ? worn : worst_worn);
    return std::bit_cast<float>((bits + worn_step_bits / 2) & ~(worn_step_bits - 1));
}

/// The worn spacings of which `step` is the step: from the first, below the second.
inline std::pair<float, float> worn_of_step(float step) {
    auto const bits = std::bit_cast<std::uint32_t>(step);
    float const next = std::bit_cast<float>(bits + worn_step_bits / 2);
    return {std::bit_cast<float>(bits - worn_step_bits / 2), next > worst_worn ? INFINITY : next};
}

} // namespace framelet
