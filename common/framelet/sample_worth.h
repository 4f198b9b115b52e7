// Rates held samples at a pixel, so that of several samples of one surface the best shows. In: their spacing once
// moved, their age, how soon the looks of what they show fade. Out: one number.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/framelet/framelet_shape.h"

namespace framelet {

/// Spacing, pixels, below which samples show nothing any better.
inline constexpr float finest_shown_spacing = 1.0f;

/// Spacing and displacement, pixels, from which on samples hide nothing. Samples that are farther apart than the
/// coarsest framelet's say too little of where their surface ends; the plane of a few that is seen from its side now
/// may not even be one.
inline constexpr float most_hiding = 8.5f;

/// True when samples of this spacing once moved, and off their positions by this much at most, both in pixels, hide
/// what lies behind them; others show only where nothing does that hides.
inline bool hides(float spacing, float misplaced) {
    return spacing < most_hiding && misplaced < most_hiding;
}

/// True when samples may be anywhere: then they show where nothing else does, be that nearer or farther.
inline bool is_astray(float spacing, float misplaced) {
    return !(misplaced < most_hiding && spacing < 8 * most_hiding);
}

/// Decorrelation rate of a code: the pixels a second (of scene time) by which samples become worse, as if they lay so
/// much farther apart. 0 for code 0.
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

/// Pixels by which samples may have gone otherwise than they were seen to go, at which they are lost: from then on they
/// show where their body has them, without their drift, and where nothing shows that is not lost.
inline constexpr float most_straying = 2;

/// Seconds of scene time, before and after its rendering, for which a sample follows its drift: until it may be
/// `most_straying` pixels off. `pixels_per_metre`: there, where it was rendered.
inline float followed_seconds(float jerk, float pixels_per_metre) {
    float const rate = jerk * pixels_per_metre;
    return rate > 0 ? std::cbrt(6 * most_straying / rate) : INFINITY;
}

/// Pixels by which a sample may be off after so many seconds, of either sign, since its drift was seen.
inline float straying(float jerk, float pixels_per_metre, float age) {
    float const seconds = std::abs(age);
    return jerk > 0 ? jerk * pixels_per_metre * (seconds * seconds * seconds / 6) : 0.0f;
}

/// True for samples of a shadow that goes over a surface: they drift on no body.
template <class AnyDrift>
bool is_shadow(BodyNumber body, AnyDrift const& drift) {
    return body == static_body && drift.any();
}

/// Seconds of scene time for which a shadow is taken to go on as it was seen to go.
inline constexpr float leading_seconds = 0.4f;

/// True when samples of this body, drift and age, where they lie on a layer, show before all that they come over,
/// however good that is.
template <class AnyDrift>
bool leads(BodyNumber body, AnyDrift const& drift, float age) {
    return is_shadow(body, drift) && std::abs(age) < leading_seconds;
}

/// True when a shadow may have gone elsewhere since it was seen: then it shows only where nothing else does, or scraps
/// of old shadows would lie about wherever they are finer than the ground.
template <class AnyDrift>
bool is_adrift(BodyNumber body, AnyDrift const& drift, float age) {
    return is_shadow(body, drift) && !leads(body, drift, age);
}

/// Width of a step of worn spacings, in bits of a float's mantissa: a quarter of each octave.
inline constexpr std::uint32_t worn_step_bits = 1u << 21;
/// Worn spacing, pixels, above which samples are no worse.
inline constexpr float worst_worn = 1e3f;

/// The worn spacing rounded to steps, so that samples that are about as good do not change places from picture to
/// picture. What is not a number is as bad as can be.
inline float worn_step(float worn) {
    auto const bits = std::bit_cast<std::uint32_t>(worn < worst_worn ? worn : worst_worn);
    return std::bit_cast<float>((bits + worn_step_bits / 2) & ~(worn_step_bits - 1));
}

/// The range of worn spacings that `worn_step` rounds to `step`: from the first on, below the second.
inline std::pair<float, float> worn_of_step(float step) {
    auto const bits = std::bit_cast<std::uint32_t>(step);
    float const next = std::bit_cast<float>(bits + worn_step_bits / 2);
    return {std::bit_cast<float>(bits - worn_step_bits / 2), next > worst_worn ? INFINITY : next};
}

} // namespace framelet
