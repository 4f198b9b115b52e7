// Encodes pictures. In: bytes of pixels. Out: a PNG file in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framelet {

/// Pixels as sRGB bytes, rows from the top, `channels` 1 (grey), 3 (RGB) or 4 (RGBA) interleaved.
struct TexturePixels {
    int width = 0;
    int height = 0;
    int channels = 1;
    std::vector<std::uint8_t> bytes;

    TexturePixels(int w, int h, int c)
        : width(w), height(h), channels(c), bytes(static_cast<std::size_t>(w) * static_cast<std::size_t>(h * c)) {}

    /// The first channel of a pixel; coordinates wrap round.
    std::uint8_t* at(int x, int y) {
        int const column = ((x % width) + width) % width;
        int const line = ((y % height) + height) % height;
        return bytes.data() +
               (static_cast<std::size_t>(line) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)) *
                   static_cast<std::size_t>(channels);
    }
};

std::string encode_png(TexturePixels const& pixels);

} // namespace framelet
