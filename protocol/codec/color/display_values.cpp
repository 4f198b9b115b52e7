#include "protocol/codec/color/display_values.h"

namespace framelet {
namespace {

constexpr std::uint16_t middle = 2048;

using Value = std::uint16_t; // 16 bits in every step, so that as many as possible fit a register

void set(DisplayValues& values, std::size_t i, Value red, Value green, Value blue) {
    values.planes[0][i] = static_cast<std::int16_t>(static_cast<Value>(4 * (red + 2 * green + blue)));
    values.planes[1][i] = static_cast<std::int16_t>(static_cast<Value>(8 * (red - blue)));
    values.planes[2][i] = static_cast<std::int16_t>(static_cast<Value>(4 * (2 * green - red - blue)));
}

/// Rounds sixteenths, modulo 2^16, to a byte and clamps them.
std::uint8_t sample(unsigned sixteenths) {
    auto const rounded = static_cast<std::int16_t>(static_cast<std::int16_t>(static_cast<Value>(sixteenths + 8)) >> 4);
    std::int16_t const at_least = rounded < 0 ? std::int16_t{0} : rounded;
    return static_cast<std::uint8_t>(at_least > 255 ? std::int16_t{255} : at_least);
}

/// Fills the samples of a framelet. `predicted(plane, i)`: sixteenths that are added to the values.
template <typename Predicted>
void put(DisplayValues const& values, Predicted const& predicted, DisplayFramelet& framelet) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        auto const y = static_cast<Value>(values.planes[0][i]), co = static_cast<Value>(values.planes[1][i]),
                   cg = static_cast<Value>(values.planes[2][i]);
        framelet.red[i] = sample(static_cast<Value>(y - cg + co + predicted(&DisplayFramelet::red, i)));
        framelet.green[i] = sample(static_cast<Value>(y + cg + predicted(&DisplayFramelet::green, i)));
        framelet.blue[i] = sample(static_cast<Value>(y - cg - co + predicted(&DisplayFramelet::blue, i)));
    }
}

} // namespace

DisplayValues display_values(DisplayFramelet const& framelet) {
    DisplayValues values;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        set(values, i, framelet.red[i], framelet.green[i], framelet.blue[i]);
        values.planes[0][i] = static_cast<std::int16_t>(values.planes[0][i] - middle);
    }
    return values;
}

DisplayValues difference(DisplayFramelet const& framelet, DisplayFramelet const& predicted) {
    DisplayValues values;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        set(values, i, static_cast<Value>(framelet.red[i] - predicted.red[i]),
            static_cast<Value>(framelet.green[i] - predicted.green[i]),
            static_cast<Value>(framelet.blue[i] - predicted.blue[i]));
    }
    return values;
}

void to_samples(DisplayValues const& values, DisplayFramelet& framelet) {
    put(
        values, [](auto, std::size_t) { return middle; }, framelet);
}

void add_to_samples(DisplayValues const& left, DisplayFramelet const& predicted, DisplayFramelet& framelet) {
    put(
        left, [&](auto const plane, std::size_t i) { return static_cast<Value>((predicted.*plane)[i] << 4); },
        framelet);
}

} // namespace framelet
