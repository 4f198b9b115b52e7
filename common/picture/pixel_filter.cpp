#include "common/picture/pixel_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "common/simd/lanes.h"

namespace framelet {

namespace {

using Words = WideWords;

Words channel_of(Words pixels, int shift) {
    return pixels >> shift & 255u;
}

/// The filtered byte `shift` / 8 of each pixel, in its place.
Words filtered_channel(Words middle, std::array<Words, 4> const& beside, int shift) {
    auto const square = [shift](Words pixels) {
        Words const value = channel_of(pixels, shift);
        return value * value;
    };
    Words const sum =
        4u * square(middle) + square(beside[0]) + square(beside[1]) + square(beside[2]) + square(beside[3]);
    // The sum is below 2^24: exact as a float.
    WideFloats const mean = __builtin_convertvector(reinterpret_cast<WideInts>(sum), WideFloats) * 0.125f;
    return reinterpret_cast<Words>(__builtin_convertvector(root(mean) + 0.5f, WideInts)) << shift;
}

/// -1 where the picture has no outline to smooth: green, of which most of brightness consists, hardly differs.
WideInts is_flat(Words middle, std::array<Words, 4> const& beside, int contrast) {
    constexpr int green = std::endian::native == std::endian::little ? 8 : 16;
    auto const value = [](Words pixels) { return reinterpret_cast<WideInts>(channel_of(pixels, green)); };
    WideInts flat = WideInts{} - 1;
    for (Words const pixels : beside) {
        WideInts const difference = value(pixels) - value(middle);
        flat &= (difference <= contrast) & (difference >= -contrast);
    }
    return flat;
}

Words filtered_pixels(Words middle, std::array<Words, 4> const& beside, int contrast) {
    constexpr int alpha = std::endian::native == std::endian::little ? 24 : 0;
    constexpr std::uint32_t opaque = 255u << alpha;
    WideInts const is_kept =
        is_flat(middle, beside, contrast) | (reinterpret_cast<WideInts>(channel_of(middle, alpha)) == exact_alpha);
    if (!any_lane(~is_kept)) {
        return middle | opaque;
    }
    Words mixed{};
    for (int shift = 0; shift < 32; shift += 8) {
        mixed |= shift == alpha ? Words{} : filtered_channel(middle, beside, shift);
    }
    return (is_kept ? middle : mixed) | opaque;
}

/// Loads pixels of a row of `width` pixels; those beyond its ends repeat the last one.
Words load_pixels(std::uint8_t const* row, int x, int width) {
    if (x >= 0 && x + wide_count <= width) {
        return load_lanes<Words>(row + 4 * x);
    }
    Words out;
    for (int i = 0; i < wide_count; ++i) {
        std::uint32_t pixel;
        std::memcpy(&pixel, row + 4 * std::clamp(x + i, 0, width - 1), sizeof pixel);
        out[i] = pixel;
    }
    return out;
}

} // namespace

void filter_pixels(Picture const& picture, PixelRect const& rect, Picture& filtered, int contrast) {
    int const width = picture.width;
    for (int y = rect.top; y < rect.bottom; ++y) {
        std::uint8_t const* const row = picture.row(y);
        std::uint8_t const* const above = picture.row(std::max(y - 1, 0));
        std::uint8_t const* const below = picture.row(std::min(y + 1, picture.height - 1));
        for (int x = rect.left; x < rect.right; x += wide_count) {
            Words const out = filtered_pixels(load_pixels(row, x, width),
                                              {load_pixels(row, x - 1, width), load_pixels(row, x + 1, width),
                                               load_pixels(above, x, width), load_pixels(below, x, width)},
                                              contrast);
            std::uint8_t* const to = filtered.row(y) + 4 * x;
            if (x + wide_count <= rect.right) {
                store_lanes(out, to); // of a size that the compiler knows
            } else {
                std::memcpy(to, &out, 4 * static_cast<std::size_t>(rect.right - x));
            }
        }
    }
}

} // namespace framelet
