// Pictures in memory. Rows from the top, pixels interleaved, no padding.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/math.h"

namespace framelet {

/// sRGB-encoded 8-bit RGBA, alpha always 255 where a picture is shown.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba; ///< width * height * 4

    Picture() = default;
    Picture(int w, int h) : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {}

    bool operator==(Picture const&) const = default;
    std::uint8_t* row(int y) { return rgba.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 4; }
    std::uint8_t const* row(int y) const {
        return rgba.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 4;
    }
};

/// Pixels of a picture as numbers of 32 bits, or lanes of them: their bytes lie in memory as the picture's do.
template <class Words>
constexpr Words picture_pixels(Words red, Words green, Words blue) {
    return std::endian::native == std::endian::little ? red | green << 8 | blue << 16 | 255u << 24
                                                      : red << 24 | green << 16 | blue << 8 | 255u;
}
constexpr std::uint32_t picture_pixel(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
    return picture_pixels(red, green, blue);
}

/// Linear float RGB.
struct FloatImage {
    int width = 0;
    int height = 0;
    std::vector<Vec3> rgb; ///< width * height

    FloatImage() = default;
    FloatImage(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

    Vec3& at(int x, int y) {
        return rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    Vec3 const& at(int x, int y) const {
        return rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

} // namespace framelet
