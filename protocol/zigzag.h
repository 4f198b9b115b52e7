// Signed numbers as unsigned ones, small for small magnitudes: 0, -1, 1, -2, ... are 0, 1, 2, 3, ...
#pragma once

#include <cstdint>

namespace framelet {

constexpr std::uint16_t zigzag(std::int16_t number) {
    return static_cast<std::uint16_t>((number < 0 ? 0xffff : 0) ^ (static_cast<std::uint16_t>(number) << 1));
}
constexpr std::int16_t from_zigzag(std::uint16_t code) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>((code >> 1) ^ (0u - (code & 1u))));
}

} // namespace framelet
