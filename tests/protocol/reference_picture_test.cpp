#include "protocol/codec/color/reference_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "protocol/codec/color/motion_search.h"
#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

constexpr Viewport viewport{200, 120};
int const pixel_depth = ImagePlane(viewport).pixel_depth();

ReferencePicture grey_picture() {
    ReferencePicture held;
    held.show(viewport);
    return held;
}

template <typename Value>
DisplayFramelet framelet_of(Tile tile, Value const& value) {
    DisplayFramelet framelet{tile, {}, {}, {}};
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        auto const v = static_cast<std::uint8_t>(value(static_cast<int>(morton_x(k)), static_cast<int>(morton_y(k))));
        framelet.red[k] = v;
        framelet.green[k] = static_cast<std::uint8_t>(v + 1);
        framelet.blue[k] = static_cast<std::uint8_t>(255 - v);
    }
    return framelet;
}

TEST(MortonRows, EachSampleIsAtItsPlace) {
    constexpr std::size_t stride = framelet_side + 5;
    SamplePlane samples, back{};
    std::iota(samples.begin(), samples.end(), std::uint8_t{0});
    std::array<std::uint8_t, framelet_side * stride> rows{};
    to_rows(samples.data(), rows.data(), stride);
    from_rows(rows.data(), stride, back.data());
    EXPECT_EQ(back, samples);
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        EXPECT_EQ(rows[morton_y(k) * stride + morton_x(k)], k);
    }
    rows.fill(0);
    back.fill(0);
    quarter_to_rows(samples.data(), rows.data(), stride);
    quarter_from_rows(rows.data(), stride, back.data());
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        bool const is_of_quarter = k < framelet_samples / 4;
        EXPECT_EQ(back[k], is_of_quarter ? k : 0);
        EXPECT_EQ(rows[morton_y(k) * stride + morton_x(k)], is_of_quarter ? k : 0);
    }
}

DisplayFramelet predicted(ReferencePicture const& held, Tile tile, MotionVector vector = {}) {
    DisplayFramelet out{tile, {}, {}, {}};
    held.predict(tile, vector, out);
    return out;
}

int red_at(DisplayFramelet const& framelet, std::uint32_t x, std::uint32_t y) {
    return framelet.red[morton_index(x, y)];
}

void take(ReferencePicture& held, DisplayFramelet const& framelet) {
    held.take(std::span(&framelet, 1));
}

TEST(ReferencePicture, IsGreyAtFirstAndForEveryOtherViewport) {
    ReferencePicture held;
    EXPECT_FALSE(held.shows(viewport));
    held.show(viewport);
    Tile const tile = make_tile(pixel_depth, 3, 2);
    EXPECT_EQ(predicted(held, tile).red, framelet_of(tile, [](int, int) { return 128; }).red);
    take(held, framelet_of(tile, [](int x, int y) { return x + y; }));
    held.show(viewport); // it stays as it is
    EXPECT_EQ(red_at(predicted(held, tile), 5, 6), 11);
    held.show({201, 120});
    EXPECT_FALSE(held.shows(viewport));
    held.show(viewport);
    EXPECT_TRUE(held == grey_picture());
}

TEST(ReferencePicture, GivesBackWhatItTookUpToHalfThePixelsSpacing) {
    std::mt19937 random(1);
    ImagePlane const plane(viewport);
    for (int depth = plane.min_depth(); depth < plane.max_depth(); ++depth) {
        ReferencePicture held = grey_picture();
        Tile const tile = make_tile(depth, 0, 0);
        DisplayFramelet const framelet = framelet_of(tile, [&](int, int) { return random(); });
        take(held, framelet);
        EXPECT_TRUE(predicted(held, tile) == framelet) << depth;
    }
}

TEST(ReferencePicture, KnownValuesOfOtherDepths) {
    ReferencePicture held = grey_picture();
    take(held, framelet_of(make_tile(pixel_depth, 1, 1), [](int x, int y) { return 10 * x + y; }));
    // A finer sample gets what covers it. A level finer, sample (2, 4) of the upper right quarter lies in sample (9,
    // 2).
    DisplayFramelet const finer = predicted(held, make_tile(pixel_depth + 1, 3, 2));
    EXPECT_EQ(red_at(finer, 2, 4), 92);
    EXPECT_EQ(red_at(finer, 3, 5), 92);
    DisplayFramelet const finest = predicted(held, make_tile(pixel_depth + 2, 7, 4));
    EXPECT_EQ(red_at(finest, 0, 0), 120);
    EXPECT_EQ(red_at(finest, 7, 15), 133);
    // A coarser sample gets the mean of the pixels about its centre; here (0, 0), (1, 0), (0, 1), (1, 1).
    DisplayFramelet const coarser = predicted(held, make_tile(pixel_depth - 1, 0, 0));
    EXPECT_EQ(red_at(coarser, 8, 8), (0 + 10 + 1 + 11 + 2) / 4);
    EXPECT_EQ(red_at(coarser, 7, 8), 128);
    // The finest samples are kept as means of four.
    take(held, framelet_of(make_tile(pixel_depth + 2, 4, 4), [](int x, int y) { return x + y; }));
    EXPECT_EQ(red_at(predicted(held, make_tile(pixel_depth + 1, 2, 2)), 1, 2), (6 + 7 + 7 + 8 + 2) / 4);
}

TEST(ReferencePicture, VectorsAreHalfPixelsAndStayInside) {
    ReferencePicture held = grey_picture();
    Tile const tile = make_tile(pixel_depth, 1, 1);
    take(held, framelet_of(tile, [](int x, int y) { return 8 * x + y; }));
    DisplayFramelet const moved = predicted(held, tile, {6, -2});
    EXPECT_EQ(red_at(moved, 0, 1), 8 * 3);
    EXPECT_EQ(red_at(moved, 12, 15), 8 * 15 + 14);
    EXPECT_EQ(red_at(moved, 13, 15), 128);
    DisplayFramelet const between = predicted(held, tile, {1, 0});
    EXPECT_EQ(red_at(between, 4, 3), 8 * 4 + 3 + 4);
    Tile const corner = make_tile(pixel_depth, 0, 0);
    EXPECT_TRUE(predicted(held, corner, {-128, -128}) == predicted(held, corner));
    // The right and lower ends are those of the coarsest tiles.
    DisplayFramelet const last = framelet_of(make_tile(pixel_depth, 15, 7), [](int x, int y) { return 16 * y + x; });
    take(held, last);
    EXPECT_TRUE(predicted(held, last.tile, {127, 127}) == last);
}

TEST(ReferencePicture, OfOneBatchTheFinerCountsWhateverTheOrder) {
    Tile const coarse_tile = make_tile(pixel_depth - 1, 1, 0);
    DisplayFramelet const coarse = framelet_of(coarse_tile, [](int, int) { return 10; });
    DisplayFramelet const fine = framelet_of(coarse_tile.child(2), [](int x, int) { return 100 + x; });
    ReferencePicture one = grey_picture(), other = one, later = one;
    one.take(std::array{coarse, fine});
    other.take(std::array{fine, coarse});
    EXPECT_TRUE(one == other);
    EXPECT_TRUE(predicted(one, fine.tile) == fine);
    EXPECT_EQ(red_at(predicted(one, coarse_tile), 8, 3), 10);
    take(later, fine);
    take(later, coarse); // a later batch
    EXPECT_EQ(red_at(predicted(later, fine.tile), 4, 4), 10);
}

/// The reference picture of one plane as PROTOCOL.md states it: all of it points.
struct FlatPicture {
    int width, height;
    std::vector<std::uint8_t> points = std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), 128);

    std::uint8_t& at(int x, int y) { return points[static_cast<std::size_t>(y * width + x)]; }

    void take(ReferencePicture::Square square, std::array<std::uint8_t, framelet_samples> const& samples) {
        auto const sample = [&](int x, int y) {
            return unsigned{samples[morton_index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))]};
        };
        for (int y = 0; y < square.side; ++y) {
            for (int x = 0; x < square.side; ++x) {
                int const i = x * framelet_side / square.side, j = y * framelet_side / square.side;
                at(square.left + x, square.top + y) = static_cast<std::uint8_t>(
                    square.side < framelet_side
                        ? (sample(i, j) + sample(i + 1, j) + sample(i, j + 1) + sample(i + 1, j + 1) + 2) / 4
                        : sample(i, j));
            }
        }
    }

    int predicted(ReferencePicture::Square square, MotionVector vector, int i, int j) {
        int const left = std::clamp(square.left + vector.x, 0, width - square.side);
        int const top = std::clamp(square.top + vector.y, 0, height - square.side);
        int const t = square.side / framelet_side;
        if (t < 2) {
            return t == 1 ? at(left + i, top + j) : at(left + i / 2, top + j / 2);
        }
        int const x = left + i * t + t / 2 - 1, y = top + j * t + t / 2 - 1;
        return (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1) + 2) / 4;
    }
};

/// In a picture of many tiles of the coarsest level, which are written side by side.
TEST(ReferencePicture, ABatchIsTakenAsItsFrameletsOneByOneFromCoarseToFine) {
    constexpr Viewport large{1200, 700};
    ImagePlane const plane(large);
    std::mt19937 random(7);
    std::vector<DisplayFramelet> batch;
    for (int i = 0; i < 600; ++i) {
        int const depth = plane.min_depth() + static_cast<int>(random() % 5);
        auto const place = static_cast<std::uint32_t>(random()) % (1u << (2 * depth));
        Tile const tile{(1u << (2 * depth)) + place};
        if (plane.accepts(tile)) {
            auto const seed = static_cast<int>(random() % 256);
            batch.push_back(framelet_of(tile, [seed](int x, int y) { return seed + 3 * x + 5 * y; }));
        }
    }
    ASSERT_GT(batch.size(), 100u);
    ReferencePicture at_once, one_by_one;
    for (ReferencePicture* const picture : {&at_once, &one_by_one}) {
        picture->show(large);
        picture->prepare_search({});
    }
    at_once.take(batch);
    std::ranges::stable_sort(batch, {}, [](DisplayFramelet const& framelet) { return framelet.tile.depth(); });
    for (DisplayFramelet const& framelet : batch) {
        one_by_one.take(std::span(&framelet, 1));
    }
    EXPECT_TRUE(at_once == one_by_one);
    EXPECT_FALSE(at_once == ReferencePicture{});
}

TEST(ReferencePicture, PredictsAsIfAllOfItWerePoints) {
    std::mt19937 random(1);
    ImagePlane const plane(viewport);
    auto const any_tile = [&] {
        for (;;) {
            int const depth =
                plane.min_depth() + static_cast<int>(random() % unsigned(plane.max_depth() - plane.min_depth() + 1));
            Tile const tile = make_tile(depth, static_cast<std::uint32_t>(random() % (1u << depth)),
                                        static_cast<std::uint32_t>(random() % (1u << depth)));
            if (plane.accepts(tile)) {
                return tile;
            }
        }
    };
    auto const component = [&] { return static_cast<std::int8_t>(random() % 3 == 0 ? 0 : random() % 256 - 128); };
    ReferencePicture held = grey_picture();
    FlatPicture flat{512, 256}, flat_green = flat;
    for (int i = 0; i < 1500; ++i) {
        DisplayFramelet const framelet = framelet_of(any_tile(), [&](int, int) { return random(); });
        take(held, framelet);
        flat.take(held.square(framelet.tile), framelet.red);
        flat_green.take(held.square(framelet.tile), framelet.green);
        Tile const tile = any_tile();
        if (i >= 500) {
            DisplayFramelet looked_for;
            looked_for.tile = tile;
            held.prepare_search({&looked_for, 1});
        }
        MotionVector const vector{component(), component()};
        DisplayFramelet const out = predicted(held, tile, vector);
        ReferencePicture::Square const square = held.square(tile);
        for (std::uint32_t k = 0; k < framelet_samples; ++k) {
            int const x = static_cast<int>(morton_x(k)), y = static_cast<int>(morton_y(k));
            ASSERT_EQ(out.red[k], flat.predicted(square, vector, x, y)) << i << " tile " << tile.code;
        }
        if (held.is_searched()) {
            // Coarse framelets are compared at every fourth point, wherever they may have been; fine ones only where
            // they are.
            int const step = SearchPicture::is_coarse(square.side) ? SearchPicture::coarse : 1;
            MotionVector const to = step > 1 ? vector : MotionVector{};
            SearchPicture::Source const source = held.searched(square, to);
            ReferencePicture::Square const from = held.moved(square, to);
            int const y = static_cast<int>(random() % unsigned(from.side / step));
            for (int x = 0; x < from.side / step; ++x) {
                auto const green = source.first[static_cast<std::size_t>(y) * source.stride + std::size_t(x)];
                auto const at = [&](int first, int points) { return (first / step + points) * step; };
                ASSERT_EQ(green, flat_green.at(at(from.left, x), at(from.top, y))) << i;
            }
        }
    }
}

TEST(MotionSearch, FindsNothingInWhatIsNotKeptForIt) {
    ReferencePicture const held = grey_picture();
    MotionSearch search;
    DisplayFramelet const framelet = framelet_of(make_tile(pixel_depth, 2, 2), [](int x, int y) { return 9 * x + y; });
    EXPECT_EQ(search.find(held, framelet), MotionVector{});
}

double scene(double x, double y) {
    return 128 + 60 * std::sin(0.13 * x) + 60 * std::cos(0.17 * y + 0.05 * x);
}

/// A picture of all of the scene, a sample a pixel, that is kept for searches.
ReferencePicture searched_picture() {
    ReferencePicture held = grey_picture();
    held.prepare_search({});
    ImagePlane const plane(viewport);
    for (std::uint32_t row = 0; row < 8; ++row) {
        for (std::uint32_t column = 0; column < 13; ++column) {
            Tile const tile = make_tile(pixel_depth, column, row);
            if (plane.accepts(tile)) {
                take(held, framelet_of(tile, [&](int x, int y) { return scene(16. * column + x, 16. * row + y); }));
            }
        }
    }
    return held;
}

/// A coarse framelet is looked for among the coarse points of finer ones.
TEST(MotionSearch, WhatIsCoarseAndStillHasHardlyMoved) {
    ReferencePicture const held = searched_picture();
    ImagePlane const plane(viewport);
    constexpr int levels = 2, spacing = 1 << levels; // pixels
    Tile const tile = make_tile(pixel_depth - levels, 1, 1);
    PixelRect const rect = plane.tile_rect(tile);
    DisplayFramelet const still = framelet_of(tile, [&](int x, int y) {
        return scene(rect.left + spacing * (x + 0.5) - 0.5, rect.top + spacing * (y + 0.5) - 0.5);
    });
    MotionVector const found = MotionSearch().find(held, still);
    EXPECT_EQ(found, MotionVector{}) << int{found.x} << " " << int{found.y};
}

TEST(MotionSearch, FindsWhatHasMoved) {
    std::mt19937 random(1);
    ReferencePicture const held = searched_picture();
    ImagePlane const plane(viewport);
    MotionSearch search;
    for (int i = 0; i < 50; ++i) {
        int const dx = static_cast<int>(random() % 9) - 4, dy = static_cast<int>(random() % 9) - 4; // pixels
        Tile const tile = make_tile(pixel_depth, 2 + random() % 8, 2 + random() % 4);
        PixelRect const rect = plane.tile_rect(tile);
        DisplayFramelet const moved =
            framelet_of(tile, [&](int x, int y) { return scene(rect.left + x + dx, rect.top + y + dy); });
        DisplayFramelet const found = predicted(held, tile, search.find(held, moved));
        int difference = 0;
        for (std::size_t k = 0; k < framelet_samples; ++k) {
            difference += std::abs(int{found.green[k]} - int{moved.green[k]});
        }
        EXPECT_LT(difference, 8 * framelet_samples) << i; // about what a pixel makes
    }
}

} // namespace
} // namespace framelet
