// The colours of age in what is drawn over pictures.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace framelet {

/// Red, green, blue, [0, 255].
using OverlayColor = std::array<float, 3>;

/// The colour of an age, from bright yellow at 0 over orange and red to dark blue at 1 and beyond.
inline OverlayColor age_color(float age) {
    constexpr std::array<OverlayColor, 4> ramp{{{255, 245, 90}, {255, 120, 20}, {170, 20, 90}, {40, 20, 120}}};
    float const place = std::clamp(age, 0.0f, 1.0f) * static_cast<float>(ramp.size() - 1);
    auto const first = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
    float const weight = place - static_cast<float>(first);
    OverlayColor out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = (1 - weight) * ramp[first][i] + weight * ramp[first + 1][i];
    }
    return out;
}

} // namespace framelet
