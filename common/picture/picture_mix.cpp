#include "common/picture/picture_mix.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "common/error.h"
#include "common/warp/warp_block.h"

namespace framelet {

namespace {

std::size_t row_bytes(PixelRect const& rect) {
    return 4 * static_cast<std::size_t>(rect.width());
}

bool is_equal(Picture const& a, Picture const& b, PixelRect const& rect) {
    for (int y = rect.top; y < rect.bottom; ++y) {
        if (std::memcmp(a.row(y) + 4 * rect.left, b.row(y) + 4 * rect.left, row_bytes(rect)) != 0) {
            return false;
        }
    }
    return true;
}

/// Mixes squares of bytes. Both products are whole numbers below 2^24: exact in single precision.
void mix_row(std::uint8_t const* first, std::uint8_t const* second, float first_share, float second_share,
             std::size_t bytes, std::uint8_t* mixed) {
    constexpr float scale = 1 / static_cast<float>(whole_share);
    for (std::size_t i = 0; i < bytes; ++i) {
        auto const a = static_cast<float>(first[i]);
        auto const b = static_cast<float>(second[i]);
        float const square = (first_share * (a * a) + second_share * (b * b)) * scale;
        mixed[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(std::sqrt(square) + 0.5f));
    }
}

/// Writes pixels for which exactly one of the two pictures shows something from that one alone.
void show_behind_holes(MixSource const& first, MixSource const& second, int y, PixelRect const& rect, Picture& mixed) {
    if (first.inverse_depth.empty() && second.inverse_depth.empty()) {
        return;
    }
    auto const row = static_cast<std::size_t>(y) * static_cast<std::size_t>(mixed.width);
    auto const is_hole = [row](MixSource const& source, int x) {
        return !source.inverse_depth.empty() && source.inverse_depth[row + static_cast<std::size_t>(x)] == hole_depth;
    };
    for (int x = rect.left; x < rect.right; ++x) {
        bool const hole = is_hole(first, x);
        if (hole != is_hole(second, x)) {
            std::memcpy(mixed.row(y) + 4 * x, (hole ? second : first).picture.row(y) + 4 * x, 4);
        }
    }
}

} // namespace

MixShare mix_share(double amount) {
    return static_cast<MixShare>(std::lround(std::clamp(amount, 0.0, 1.0) * whole_share));
}

bool mix_pictures(MixSource const& first, MixSource const& second, MixShare share, PixelRect const& rect,
                  Picture& mixed) {
    FRAMELET_CHECK(share >= 0 && share <= whole_share);
    if (is_equal(first.picture, second.picture, rect)) {
        copy_pixels(second.picture, rect, mixed);
        return false;
    }
    auto const second_share = static_cast<float>(share);
    auto const first_share = static_cast<float>(whole_share - share);
    for (int y = rect.top; y < rect.bottom; ++y) {
        mix_row(first.picture.row(y) + 4 * rect.left, second.picture.row(y) + 4 * rect.left, first_share, second_share,
                row_bytes(rect), mixed.row(y) + 4 * rect.left);
        show_behind_holes(first, second, y, rect, mixed);
    }
    return true;
}

void copy_pixels(Picture const& from, PixelRect const& rect, Picture& to) {
    for (int y = rect.top; y < rect.bottom; ++y) {
        std::memcpy(to.row(y) + 4 * rect.left, from.row(y) + 4 * rect.left, row_bytes(rect));
    }
}

} // namespace framelet
