// What can be drawn over pictures, by name. In: a name, as a command line or a menu has it. Out: the kind, and back.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framelet {

/// The kinds of overlay that can be drawn over a picture.
enum class DrawnOver : std::uint8_t { nothing, ages, confidence, refresh_rate, arrivals, holes };

/// The kinds' names, in their order.
inline constexpr std::array drawn_over_names{"none", "ages", "confidence", "refresh-rate", "arrivals", "holes"};

constexpr char const* name_of(DrawnOver what) {
    return drawn_over_names[static_cast<std::size_t>(what)];
}

/// The kind of this name; nothing where none has it.
inline std::optional<DrawnOver> drawn_over_of(std::string_view name) {
    for (std::size_t i = 0; i < drawn_over_names.size(); ++i) {
        if (name == drawn_over_names[i]) {
            return static_cast<DrawnOver>(i);
        }
    }
    return std::nullopt;
}

/// All names, as a sentence lists them: "none, ages, ... or holes".
inline std::string list_of_drawn_over() {
    std::string out;
    for (std::size_t i = 0; i < drawn_over_names.size(); ++i) {
        out += i == 0 ? "" : i + 1 < drawn_over_names.size() ? ", " : " or ";
        out += drawn_over_names[i];
    }
    return out;
}

/// The kind after this one; after the last comes the first.
constexpr DrawnOver next_of(DrawnOver what) {
    return static_cast<DrawnOver>((static_cast<std::size_t>(what) + 1) % drawn_over_names.size());
}

} // namespace framelet
