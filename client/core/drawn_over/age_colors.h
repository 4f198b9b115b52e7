// The colours of what is drawn over pictures, and how they are put on one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace framelet {

/// Red, green, blue, [0, 255].
using OverlayColor = std::array<float, 3>;

/// The colour of pixels of which nothing is held.
inline constexpr OverlayColor hole_color{255, 0, 255};

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

/// Share of a colour in a pixel that is washed with it and still to be recognised.
inline constexpr float usual_share = 0.6f;

/// Makes a pixel (red, green, blue) grey, and mixes this share of the colour in.
inline void wash(std::uint8_t* pixel, OverlayColor const& color, float share) {
    auto const grey = static_cast<float>(pixel[0] + 2 * pixel[1] + pixel[2]) / 4;
    for (std::size_t i = 0; i < color.size(); ++i) {
        pixel[i] = static_cast<std::uint8_t>(std::lround((1 - share) * grey + share * color[i]));
    }
}

} // namespace framelet
