// A prediction of which details are weakened: the finest of a picture that has moved are often noise rather than what
// will be seen again. In: predicted values. Out: the same with fewer details. PROTOCOL.md has the rule.
#pragma once

#include <cstdint>

#include "protocol/display_values.h"
#include "protocol/haar_planes.h"

namespace framelet {

/// What becomes of the details of an octave.
enum class Details : std::uint8_t { whole = 0, halved = 1, none = 2 };
inline constexpr std::uint8_t detail_choices = 3;

/// Of the two finest octaves; the others stay whole.
struct Damping {
    static constexpr std::size_t octaves = 2;
    std::array<Details, octaves> of{}; ///< from the finest

    bool operator==(Damping const&) const = default;
};

/// What a reader predicts.
void damp(DisplayValues& values, Damping damping);

} // namespace framelet
