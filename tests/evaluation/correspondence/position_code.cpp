#include "tests/evaluation/correspondence/position_code.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace framelet::bench {

namespace {

constexpr int period = 2 * position_steps;
constexpr int shift_pixels = (position_steps + 1) / 2;

std::array<float, position_steps + 1> const& squares() {
    static auto const table = [] {
        std::array<float, position_steps + 1> out{};
        for (std::size_t k = 0; k < out.size(); ++k) {
            float const byte = std::round(255 * std::sqrt(static_cast<float>(k) / position_steps));
            out[k] = byte * byte;
        }
        return out;
    }();
    return table;
}

/// Distance in pixels from the code's last upward turn, in [0, period).
float phase(float position, int shift) {
    float const from = position - 0.5f + static_cast<float>(shift * shift_pixels);
    return from - period * std::floor(from / period);
}

} // namespace

std::uint8_t position_byte(int index, int shift) {
    int const at = (index + shift * shift_pixels) % period;
    auto const step = static_cast<std::size_t>(at <= position_steps ? at : period - at);
    return static_cast<std::uint8_t>(std::sqrt(squares()[step]));
}

float position_of(float mean_square, int shift, float near) {
    auto const& table = squares();
    auto const above = std::clamp<std::ptrdiff_t>(
        std::upper_bound(table.begin(), table.end(), mean_square) - table.begin(), 1, position_steps);
    float const low = table[static_cast<std::size_t>(above - 1)];
    float const high = table[static_cast<std::size_t>(above)];
    float const step = static_cast<float>(above - 1) + (mean_square - low) / (high - low);
    float const at = phase(near, shift);
    float best = INFINITY;
    for (float const candidate : {step, period - step, step - period, period + step, -step, 2 * period - step}) {
        best = std::abs(candidate - at) < std::abs(best) ? candidate - at : best;
    }
    return near + best;
}

int steady_shift(float near) {
    auto const distance = [near](int shift) {
        float const at = std::fmod(phase(near, shift), static_cast<float>(position_steps));
        return std::min(at, position_steps - at);
    };
    return distance(0) >= distance(1) ? 0 : 1;
}

} // namespace framelet::bench
