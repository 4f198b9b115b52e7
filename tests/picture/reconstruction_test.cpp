#include "common/picture/reconstruction.h"

#include <gtest/gtest.h>

#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

Picture full_picture(FrameletCache const& cache) {
    Picture picture(cache.plane().viewport().width, cache.plane().viewport().height);
    reconstruct_all(cache, picture);
    return picture;
}

int pixel(Picture const& picture, int x, int y, int channel = 0) {
    return picture.row(y)[4 * x + channel];
}

/// A byte ramp that is linear in light: 0 at `low`, full at `high`.
std::uint8_t ramp(float position, float low, float high) {
    return srgb_byte_from_linear((position - low) / (high - low));
}

TEST(Reconstruction, ConstantStaysConstantAtEveryDepth) {
    ImagePlane const plane(Viewport{150, 70});
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        for (int const value : {0, 1, 7, 64, 128, 200, 254, 255}) {
            FrameletCache cache(plane);
            std::vector<DisplayFramelet> framelets;
            for (Tile const tile : visible_tiles(plane, depth)) {
                framelets.push_back(constant_framelet(plane, tile, static_cast<std::uint8_t>(value)));
            }
            cache.insert(make_batch(plane, 1, framelets));
            Picture const picture = full_picture(cache);
            for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
                ASSERT_EQ(picture.rgba[i], i % 4 == 3 ? 255 : value) << "depth " << depth << ", byte " << i;
            }
        }
    }
}

TEST(Reconstruction, RampIsExactAcrossBorders) {
    Viewport const viewport{300, 200};
    ImagePlane const plane(viewport);
    auto const shade = [](float x, float y) {
        return std::array{ramp(x, -40, 360), ramp(y, -40, 260), ramp(x + y, -40, 560)};
    };
    for (int depth = plane.min_depth(); depth <= plane.max_depth(); ++depth) {
        FrameletCache cache(plane);
        cache.insert(make_batch(plane, 1, shade_tiles(plane, visible_tiles(plane, depth), shade)));
        Picture const picture = full_picture(cache);
        // Tiles that reach beyond the viewport's edge still hold samples there, except where the edge is theirs.
        for (int y = 4; y < viewport.height - 8; ++y) {
            for (int x = 4; x < viewport.width - 8; ++x) {
                auto const expected = shade(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                for (int channel = 0; channel < 3; ++channel) {
                    ASSERT_NEAR(pixel(picture, x, y, channel), expected[static_cast<std::size_t>(channel)], 1)
                        << "depth " << depth << " at " << x << "," << y;
                }
            }
        }
    }
}

TEST(Reconstruction, NeighboursOfTheSameMomentShowNoSeamWhicheverComesFirst) {
    ImagePlane const plane(Viewport{128, 64});
    auto const shade = [](float x, float) { return std::array{ramp(x, -8, 136), ramp(x, -8, 136), ramp(x, -8, 136)}; };
    int const depth = plane.pixel_depth() - 2; // spacing 4, tiles of 64 pixels
    for (int const first : {0, 1}) {
        FrameletCache cache(plane);
        Picture picture(128, 64);
        std::vector<PixelRect> changed;
        for (int const column : {first, 1 - first}) {
            Tile const tile = make_tile(depth, static_cast<std::uint32_t>(column), 0);
            Batch batch =
                make_batch(plane, static_cast<std::uint64_t>(column + 1), {shade_framelet(plane, tile, shade)});
            batch.scene_time = 2.5;
            cache.insert(batch);
            cache.take_changed(changed);
            reconstruct(cache, changed, picture);
        }
        for (int x = 2; x < 126; ++x) {
            EXPECT_NEAR(pixel(picture, x, 30), ramp(static_cast<float>(x) + 0.5f, -8, 136), 1) << x;
        }
    }
}

TEST(Reconstruction, OtherMomentsAreNotMixed) {
    ImagePlane const plane(Viewport{128, 64});
    int const depth = plane.pixel_depth() - 2;
    FrameletCache cache(plane);
    Batch left = make_batch(plane, 1, {constant_framelet(plane, make_tile(depth, 0, 0), 20)});
    Batch right = make_batch(plane, 2, {constant_framelet(plane, make_tile(depth, 1, 0), 220)});
    right.scene_time = 1;
    cache.insert(left);
    cache.insert(right);
    Picture picture = full_picture(cache);
    EXPECT_EQ(pixel(picture, 63, 10), 20);
    EXPECT_EQ(pixel(picture, 64, 10), 220);
    // The same two framelets, once of one moment, are interpolated.
    right.number = 3;
    right.scene_time = 0;
    cache.insert(right);
    picture = full_picture(cache);
    EXPECT_GT(pixel(picture, 63, 10), 100);
    EXPECT_LT(pixel(picture, 64, 10), 200);
}

TEST(Reconstruction, CoarseMeetsTheMeanOfItsFinerNeighbour) {
    ImagePlane const plane(Viewport{128, 64});
    auto const shade = [](float x, float y) {
        return std::array{ramp(x, -8, 136), ramp(y, -8, 136), ramp(x, -8, 136)};
    };
    FrameletCache cache(plane);
    int const depth = plane.pixel_depth() - 1; // spacing 2, tiles of 32 pixels, beside pixels and quarter pixels
    std::vector<DisplayFramelet> framelets{shade_framelet(plane, make_tile(depth, 0, 0), shade)};
    for (std::uint32_t row = 0; row < 2; ++row) {
        framelets.push_back(shade_framelet(plane, make_tile(depth + 1, 2, row), shade));
    }
    for (std::uint32_t row = 0; row < 4; ++row) {
        framelets.push_back(shade_framelet(plane, make_tile(depth + 2, row, 4), shade));
    }
    cache.insert(make_batch(plane, 1, framelets));
    Picture const picture = full_picture(cache);
    for (int i = 1; i < 31; ++i) {
        for (int k = 1; k < 40; ++k) {
            EXPECT_NEAR(pixel(picture, k, i), ramp(static_cast<float>(k) + 0.5f, -8, 136), 1) << k << "," << i;
            EXPECT_NEAR(pixel(picture, i, k, 1), ramp(static_cast<float>(k) + 0.5f, -8, 136), 1) << i << "," << k;
        }
    }
}

TEST(Reconstruction, FineFrameletIsTheBoxMeanInLinearLight) {
    ImagePlane const plane(Viewport{32, 16});
    std::mt19937 random(3);
    for (int levels = 1; levels <= 2; ++levels) {
        int const n = 1 << levels;
        std::array<std::array<float, 64>, 64> light{}; // linear light of the samples of the whole 16x16 block
        FrameletCache cache(plane);
        std::vector<DisplayFramelet> framelets;
        for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(n); ++row) {
            for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(n); ++column) {
                DisplayFramelet framelet = random_framelet(plane, random);
                framelet.tile = make_tile(plane.pixel_depth() + levels, column, row);
                for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                    light[row * 16 + morton_y(i)][column * 16 + morton_x(i)] = linear_from_srgb_byte(framelet.red[i]);
                }
                framelets.push_back(framelet);
            }
        }
        cache.insert(make_batch(plane, 1, framelets));
        Picture const picture = full_picture(cache);
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                double sum = 0;
                for (int j = 0; j < n; ++j) {
                    for (int i = 0; i < n; ++i) {
                        sum += static_cast<double>(
                            light[static_cast<std::size_t>(y * n + j)][static_cast<std::size_t>(x * n + i)]);
                    }
                }
                int const expected = srgb_byte_from_linear(static_cast<float>(sum / (n * n)));
                ASSERT_NEAR(pixel(picture, x, y), expected, 1) << levels << " levels at " << x << "," << y;
            }
        }
    }
}

TEST(Reconstruction, NewestWinsWhateverTheSizeAndNothingIsDarkGrey) {
    ImagePlane const plane(Viewport{64, 48});
    int const depth = plane.pixel_depth();
    FrameletCache cache(plane);
    Batch const middle = make_batch(plane, 2, {constant_framelet(plane, make_tile(depth, 1, 1), 100)});
    Batch const fine = make_batch(plane, 3, {constant_framelet(plane, make_tile(depth + 2, 4, 4), 200)});
    Batch const half = make_batch(plane, 1,
                                  {constant_framelet(plane, make_tile(depth + 1, 4, 2), 60),
                                   constant_framelet(plane, make_tile(depth + 1, 2, 2), 250)});
    for (Batch const* batch : {&fine, &half, &middle}) {
        cache.insert(*batch);
    }
    Picture const picture = full_picture(cache);
    EXPECT_EQ(pixel(picture, 17, 17), 200);
    EXPECT_EQ(pixel(picture, 20, 17), 100);
    EXPECT_EQ(pixel(picture, 31, 31), 100);
    EXPECT_EQ(pixel(picture, 32, 16), 60);
    EXPECT_EQ(pixel(picture, 40, 16), srgb_byte_from_linear(uncovered_light));
    EXPECT_EQ(pixel(picture, 63, 47), srgb_byte_from_linear(uncovered_light));
    EXPECT_EQ(pixel(picture, 63, 47, 3), 255);
}

/// Inserts batches, some of which share moments, in their order and in another one.
TEST(Reconstruction, IncrementalEqualsFullAndOrderDoesNotMatter) {
    for (Viewport const viewport : {Viewport{1, 1}, Viewport{17, 5}, Viewport{200, 90}, Viewport{640, 360}}) {
        ImagePlane const plane(viewport);
        std::mt19937 random(static_cast<unsigned>(viewport.width * 7));
        std::vector<Batch> batches;
        for (int i = 0; i < 120; ++i) {
            Batch batch = make_batch(plane, static_cast<std::uint64_t>(i / 2 + 1), {});
            batch.scene_time = i / 8;
            // Two halves of one batch may not name a tile twice: the first has even columns, the second odd ones.
            for (int k = 0; k < 12; ++k) {
                DisplayFramelet framelet = random_framelet(plane, random);
                bool const named = std::any_of(batch.framelets.begin(), batch.framelets.end(),
                                               [&](auto const& other) { return other.tile == framelet.tile; });
                if (!named && framelet.tile.column() % 2 == static_cast<unsigned>(i % 2)) {
                    batch.framelets.push_back(framelet);
                }
            }
            batches.push_back(batch);
        }
        Picture first_order;
        for (int order = 0; order < 2; ++order) {
            FrameletCache cache(plane);
            Picture picture = full_picture(cache);
            std::vector<PixelRect> changed;
            for (std::size_t i = 0; i < batches.size(); ++i) {
                cache.insert(batches[i]);
                if (i % 5 == 4) {
                    cache.take_changed(changed);
                    reconstruct(cache, changed, picture);
                    ASSERT_TRUE(picture == full_picture(cache)) << viewport.width << " after " << i;
                }
            }
            if (order == 0) {
                first_order = picture;
            } else {
                EXPECT_TRUE(picture == first_order) << viewport.width;
            }
            std::shuffle(batches.begin(), batches.end(), random);
        }
    }
}

} // namespace
} // namespace framelet
