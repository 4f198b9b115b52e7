// Zigzag code: signed numbers as unsigned ones, small for small magnitudes: 0, -1, 1, -2, ... are 0, 1, 2, 3, ...
#pragma once

#include <concepts>
#include <limits>
#include <type_traits>

namespace framelet {

template <std::signed_integral Number>
constexpr std::make_unsigned_t<Number> zigzag(Number number) {
    using Code = std::make_unsigned_t<Number>;
    using Wide = std::common_type_t<Code, unsigned>;
    Wide const sign = number < 0 ? std::numeric_limits<Code>::max() : 0u;
    return static_cast<Code>(sign ^ (Wide{static_cast<Code>(number)} << 1));
}
template <std::unsigned_integral Code>
constexpr std::make_signed_t<Code> from_zigzag(Code code) {
    using Wide = std::common_type_t<Code, unsigned>;
    return static_cast<std::make_signed_t<Code>>(static_cast<Code>((Wide{code} >> 1) ^ (Wide{0} - (code & 1u))));
}

} // namespace framelet
