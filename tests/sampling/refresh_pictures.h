// Pictures that the tests of refreshing render. In: a position in pixels, a scene time. Out: display-encoded grey.
#pragma once

#include "tests/sampling/synthetic_refresh.h"

namespace framelet::test {

inline constexpr Viewport small{256, 200};

inline float flat(float, float, double) {
    return 0.25f;
}
inline float texture(float x, float y, double) {
    return smooth_noise(x / 5, y / 5);
}
/// The texture, which goes 40 pixels a second to the right.
inline float moving_texture(float x, float y, double time) {
    return smooth_noise((x - static_cast<float>(40 * time)) / 5, y / 5);
}

/// A picture whose right half has detail finer than any sample.
inline float half_dust(float x, float y, double time) {
    return x < 128 ? flat(x, y, time) : smooth_noise(9 * x, 9 * y);
}

} // namespace framelet::test
