#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "common/picture/pixel_filter.h"

namespace framelet {
namespace {

Picture random_picture(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Picture picture(width, height);
    for (std::uint8_t& byte : picture.rgba) {
        byte = static_cast<std::uint8_t>(random());
    }
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        picture.rgba[i] = random() % 2 == 0 ? exact_alpha : std::uint8_t{0};
    }
    return picture;
}

/// The definition, pixel by pixel.
std::array<std::uint8_t, 4> filtered_pixel(Picture const& picture, int x, int y) {
    auto const at = [&](int i, int j) {
        return picture.row(std::clamp(j, 0, picture.height - 1)) + 4 * std::clamp(i, 0, picture.width - 1);
    };
    std::array const beside{at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)};
    std::uint8_t const* const own = at(x, y);
    auto const is_like = [own](std::uint8_t const* pixel) { return std::abs(pixel[1] - own[1]) <= flat_contrast; };
    bool const is_kept = own[3] == exact_alpha || std::ranges::all_of(beside, is_like);
    std::array<std::uint8_t, 4> out{own[0], own[1], own[2], 255};
    for (std::size_t c = 0; c < 3 && !is_kept; ++c) {
        double sum = 4.0 * own[c] * own[c];
        for (std::uint8_t const* const pixel : beside) {
            sum += static_cast<double>(pixel[c]) * pixel[c];
        }
        out[c] = static_cast<std::uint8_t>(std::lround(std::sqrt(sum / 8)));
    }
    return out;
}

/// Filters pictures of all sizes, and rectangles that begin and end anywhere: what lies outside is left alone.
TEST(PixelFilter, IsWhatItSays) {
    std::mt19937 random(1);
    auto const below = [&random](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
    for (unsigned seed = 0; seed < 300; ++seed) {
        Picture const picture = random_picture(1 + below(70), 1 + below(20), seed);
        PixelRect rect{below(picture.width), below(picture.height), 0, 0};
        rect.right = rect.left + 1 + below(picture.width - rect.left);
        rect.bottom = rect.top + 1 + below(picture.height - rect.top);
        Picture filtered(picture.width, picture.height);
        filter_pixels(picture, rect, filtered);
        for (int y = 0; y < picture.height; ++y) {
            for (int x = 0; x < picture.width; ++x) {
                bool const inside = x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom;
                auto const expected = inside ? filtered_pixel(picture, x, y) : std::array<std::uint8_t, 4>{};
                for (std::size_t c = 0; c < 4; ++c) {
                    ASSERT_NEAR((filtered.row(y) + 4 * x)[c], expected[c], inside ? 1 : 0)
                        << seed << " " << x << " " << y;
                }
            }
        }
    }
}

TEST(PixelFilter, NoContrastIsGreaterThanABytes) {
    Picture const picture = random_picture(33, 9, 1);
    Picture filtered(picture.width, picture.height);
    filter_pixels(picture, {0, 0, picture.width, picture.height}, filtered, 255);
    Picture expected = picture;
    for (std::size_t i = 3; i < expected.rgba.size(); i += 4) {
        expected.rgba[i] = 255;
    }
    EXPECT_EQ(filtered, expected);
}

/// A line becomes wider, and as much darker.
TEST(PixelFilter, KeepsTheLight) {
    Picture picture(48, 4);
    for (int y = 0; y < picture.height; ++y) {
        std::fill_n(picture.row(y) + 4 * 20, 3, std::uint8_t{200});
    }
    Picture filtered(picture.width, picture.height);
    filter_pixels(picture, {0, 0, picture.width, picture.height}, filtered);
    double light = 0;
    for (int x = 0; x < picture.width; ++x) {
        light += std::pow((filtered.row(2) + 4 * x)[0], 2);
    }
    EXPECT_NEAR(light / (200.0 * 200.0), 1, 0.01);
    EXPECT_NEAR((filtered.row(2) + 80)[0], 200 * std::sqrt(0.75), 1);
}

} // namespace
} // namespace framelet
