// Functions that the error estimators share: sums of energies, and energies against their template.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tests/evaluation/methods/response/rate_error.h"

namespace framelet {

/// Sum of value(i), i < count, in several partial sums: additions that need not wait for each other.
template <class Value>
float sum_of(std::size_t count, Value&& value) {
    constexpr std::size_t lanes = 16;
    float sum = 0;
    std::size_t i = 0;
    if (count >= lanes) {
        std::array<float, lanes> partial{};
        for (; i + lanes <= count; i += lanes) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                partial[lane] += value(i + lane);
            }
        }
        for (float const part : partial) {
            sum += part;
        }
    }
    for (; i < count; ++i) {
        sum += value(i);
    }
    return sum;
}

/// Octave of refreshes `seconds` apart, relative to `template_interval`. Clamped to 16 octaves, beyond any refresh
/// interval in use, so that templates stay finite and above 0.
inline float octave_of_interval(float seconds) {
    return std::clamp(std::log2(seconds / template_interval), -16.0f, 16.0f);
}

inline float energy_allowed(EnergyTemplate const& line, float octave) {
    return std::exp2(line.offset + line.slope * octave);
}

/// Signed difference of energies: tanh of half the natural logarithm of energy / allowed: in [-1, 1], 0 where they
/// agree. `allowed` > 0.
inline float compare_energies(float energy, float allowed) {
    return (energy - allowed) / (energy + allowed);
}

} // namespace framelet
