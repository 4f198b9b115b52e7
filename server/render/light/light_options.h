// How the light of a served scene is simulated. In: words of the command line. Out: a value.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace framelet {

enum class LightMethod : std::uint8_t {
    direct, ///< of lights and environment, with shadows of lights, and mirror reflections
    reference, ///< all of it, by paths: exact, noisy while anything moves
    full ///< all of it, by the light cache: smooth while anything moves, and by paths in the end where nothing does
};

/// The method that a word stands for. Throws InputError for other words.
LightMethod parse_light_method(std::string const& word);
/// Its word.
char const* name_of(LightMethod method);

/// Who says which method a scene has.
enum class LightChoice : std::uint8_t {
    told,
    by_view ///< what the first camera sees: full where it looks other than direct, which costs half as much
};

struct LightOptions {
    LightMethod method = LightMethod::direct;
    float sun_degrees = 0.53f; ///< angular diameter of directional lights; 0: hard
    /// Diameter of point and spot lights, metres; 0: hard. Nothing: a tenth, in a small scene a hundredth of its size.
    std::optional<float> lamp_metres{};

    bool operator==(LightOptions const&) const = default;
};

} // namespace framelet
