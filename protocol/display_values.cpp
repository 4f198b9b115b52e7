#include "protocol/display_values.h"

#include <algorithm>

namespace framelet {
namespace {

constexpr int middle = 2048;

std::int16_t wrapped(int value) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
}

/// Sixteenths, modulo 2^16, to a byte.
std::uint8_t sample(int sixteenths) {
    return static_cast<std::uint8_t>(std::clamp(wrapped(sixteenths + middle + 8) >> 4, 0, 255));
}

} // namespace

DisplayValues display_values(DisplayFramelet const& framelet) {
    DisplayValues values;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        int const red = framelet.red[i], green = framelet.green[i], blue = framelet.blue[i];
        values.planes[0][i] = static_cast<std::int16_t>(4 * (red + 2 * green + blue) - middle);
        values.planes[1][i] = static_cast<std::int16_t>(8 * (red - blue));
        values.planes[2][i] = static_cast<std::int16_t>(4 * (2 * green - red - blue));
    }
    return values;
}

DisplayValues operator-(DisplayValues const& a, DisplayValues const& b) {
    DisplayValues out;
    for (std::size_t plane = 0; plane < out.planes.size(); ++plane) {
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            out.planes[plane][i] = wrapped(a.planes[plane][i] - b.planes[plane][i]);
        }
    }
    return out;
}

DisplayValues operator+(DisplayValues const& a, DisplayValues const& b) {
    DisplayValues out;
    for (std::size_t plane = 0; plane < out.planes.size(); ++plane) {
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            out.planes[plane][i] = wrapped(a.planes[plane][i] + b.planes[plane][i]);
        }
    }
    return out;
}

void to_samples(DisplayValues const& values, DisplayFramelet& framelet) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        int const y = values.planes[0][i], co = values.planes[1][i], cg = values.planes[2][i];
        framelet.red[i] = sample(y - cg + co);
        framelet.green[i] = sample(y + cg);
        framelet.blue[i] = sample(y - cg - co);
    }
}

} // namespace framelet
