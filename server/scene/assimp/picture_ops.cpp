#include "server/scene/assimp/picture_ops.h"

#include <algorithm>

namespace framelet {
namespace {

bool has_alpha(Picture const& picture) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        if (picture.rgba[i] != 255) {
            return true;
        }
    }
    return false;
}

} // namespace

Picture with_opacity(Picture const* color, Picture const& opacity) {
    Picture result = color ? *color : Picture(opacity.width, opacity.height);
    if (!color) {
        std::fill(result.rgba.begin(), result.rgba.end(), std::uint8_t(255));
    }
    bool const use_alpha = has_alpha(opacity);
    for (int y = 0; y < result.height; ++y) {
        auto const from_y = static_cast<int>((y + 0.5) * opacity.height / result.height);
        std::uint8_t* const row = result.row(y);
        std::uint8_t const* const from_row = opacity.row(from_y);
        for (int x = 0; x < result.width; ++x) {
            auto const from_x = static_cast<int>((x + 0.5) * opacity.width / result.width);
            std::uint8_t const* const from = from_row + from_x * 4;
            row[x * 4 + 3] = use_alpha ? from[3] : std::max({from[0], from[1], from[2]});
        }
    }
    return result;
}

bool is_cutout(Picture const& picture) {
    std::size_t between = 0;
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        between += picture.rgba[i] > 16 && picture.rgba[i] < 239;
    }
    return between * 20 <= picture.rgba.size() / 4; // edges are soft
}

bool is_normal_map(Picture const& picture) {
    std::uint64_t red = 0;
    std::uint64_t green = 0;
    std::uint64_t blue = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        red += picture.rgba[i];
        green += picture.rgba[i + 1];
        blue += picture.rgba[i + 2];
    }
    return blue * 10 > red * 12 && blue * 10 > green * 12;
}

} // namespace framelet
