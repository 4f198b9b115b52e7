#include "common/files/tga_palette.h"

#include <algorithm>
#include <cstdint>

namespace framelet {
namespace {

/// The number of one byte or two, the lower first; the file has them.
std::size_t number(std::span<std::byte const> tga, std::size_t at, std::size_t bytes) {
    auto const low = std::to_integer<std::size_t>(tga[at]);
    return bytes == 1 ? low : low | std::to_integer<std::size_t>(tga[at + 1]) << 8;
}

/// The largest of the entries that pixels name, as far as the file goes.
std::size_t largest_index(std::span<std::byte const> tga, std::size_t at, std::size_t pixels, std::size_t index_bytes,
                          bool is_packed) {
    std::size_t largest = 0;
    while (pixels > 0) {
        std::size_t count = pixels, named = pixels; // pixels, and those of them that say which entry is theirs
        if (is_packed) {
            if (at >= tga.size()) {
                break;
            }
            auto const packet = std::to_integer<std::size_t>(tga[at++]);
            count = std::min(pixels, (packet & 0x7f) + 1);
            named = (packet & 0x80) != 0 ? 1 : count;
        }
        for (; named > 0 && at + index_bytes <= tga.size(); --named) {
            largest = std::max(largest, number(tga, at, index_bytes));
            at += index_bytes;
        }
        if (named > 0) {
            break;
        }
        pixels -= count;
    }
    return largest;
}

} // namespace

char const* tga_palette_problem(std::span<std::byte const> tga) {
    constexpr std::size_t header_bytes = 18;
    constexpr std::size_t packed = 9;
    if (tga.size() < header_bytes) {
        return nullptr;
    }
    std::size_t const id_bytes = number(tga, 0, 1), type = number(tga, 2, 1);
    if (type != 1 && type != packed) {
        return nullptr;
    }
    std::size_t const first = number(tga, 3, 2), entries = number(tga, 5, 2), entry_bits = number(tga, 7, 1);
    std::size_t const pixels = number(tga, 12, 2) * number(tga, 14, 2), index_bits = number(tga, 16, 1);
    if (first != 0) {
        return "its palette begins at another entry than the first, which is not read: save it without a palette";
    }
    if (entry_bits != 15 && entry_bits != 16 && entry_bits != 24 && entry_bits != 32) {
        return "the colours of its palette have a size that no TGA has";
    }
    if (index_bits != 8 && index_bits != 16) {
        return "its pixels name entries of its palette by a size that no TGA has";
    }
    std::size_t const begin = header_bytes + id_bytes + entries * ((entry_bits + 7) / 8);
    bool const is_within = largest_index(tga, begin, pixels, index_bits / 8, type == packed) < entries;
    return is_within ? nullptr : "it has pixels whose colour is not in its palette";
}

} // namespace framelet
