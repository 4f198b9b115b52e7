#include "tests/evaluation/measures/measures.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/files/image_io.h"
#include "tests/evaluation/measures/ratio_summary.h"

namespace framelet::bench {
namespace {

Picture plain(int width, int height, std::array<std::uint8_t, 3> color) {
    Picture picture(width, height);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = i % 4 == 3 ? 255 : color[i % 4];
    }
    return picture;
}

/// A picture with a bit of everything; known_values.py makes the same.
Picture pattern(int shift) {
    Picture picture(48, 40);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 48; ++x) {
            int const u = x + shift;
            std::uint8_t* const p = picture.row(y) + std::ptrdiff_t(x) * 4;
            p[0] = static_cast<std::uint8_t>((u * 5 + y * 2) % 256);
            p[1] = static_cast<std::uint8_t>((u / 8 + y / 8) % 2 == 0 ? 40 : 210);
            p[2] = static_cast<std::uint8_t>((u * u + 3 * y * y) / 7 % 256);
            p[3] = 255;
        }
    }
    return picture;
}

TEST(Measures, KnownValuesOfOtherPeoplesTools) {
    std::filesystem::path const folder = FRAMELET_SOURCE_DIR "/../shared/reference/metrics";
    std::ifstream csv(folder / "known_values.csv");
    if (!csv) {
        GTEST_SKIP() << "no known values beside the checkout";
    }
    int compared = 0;
    for (std::string line; std::getline(csv, line);) {
        if (line.empty() || line[0] == '#' || line.starts_with("image,")) {
            continue;
        }
        std::istringstream fields(line);
        std::array<std::string, 6> f;
        for (std::string& field : f) {
            std::getline(fields, field, ',');
        }
        Measures const m =
            measure(read_picture(folder / (f[0] + "_" + f[1] + ".png")), read_picture(folder / (f[0] + "_ref.png")));
        EXPECT_NEAR(m.mse, std::stod(f[2]), 1e-8) << line;
        EXPECT_NEAR(m.psnr, std::stod(f[3]), 0.001) << line;
        EXPECT_NEAR(m.ssim, std::stod(f[4]), 0.002) << line;
        EXPECT_NEAR(m.flip, std::stod(f[5]), 0.001) << line;
        ++compared;
    }
    EXPECT_EQ(compared, 8);
}

TEST(Measures, PatternAsTheDefinitionsSay) {
    // The values are from known_values.py: the definitions, written down a second time, without separable filters.
    Measures const m = measure(pattern(1), pattern(0));
    EXPECT_NEAR(m.mse, 0.031933471, 1e-9);
    EXPECT_NEAR(m.psnr, 14.95754, 1e-4);
    EXPECT_NEAR(m.ssim, 0.655651, 1e-4);
    EXPECT_NEAR(m.flip, 0.356647, 1e-4);
}

TEST(Measures, EqualPicturesHaveNoError) {
    Measures const m = measure(pattern(3), pattern(3));
    EXPECT_EQ(m.mse, 0);
    EXPECT_EQ(m.psnr, 100);
    EXPECT_EQ(m.ssim, 1);
    EXPECT_EQ(m.flip, 0);
    EXPECT_NEAR(structural_similarity(pattern(3), pattern(3)), 1, 1e-9);
    EXPECT_EQ(mean_flip(pattern(3), pattern(3)), 0);
}

TEST(Measures, PlainPicturesByHand) {
    Picture const a = plain(40, 30, {51, 51, 51});
    Picture const b = plain(40, 30, {102, 102, 102});
    EXPECT_NEAR(mean_squared_error(a, b), 0.04, 1e-12);
    EXPECT_NEAR(psnr_from_mse(0.04), 13.9794, 1e-4);
    EXPECT_NEAR(structural_similarity(a, b), (2.0 * 51 * 102 + 6.5025) / (51.0 * 51 + 102.0 * 102 + 6.5025), 1e-5);
    EXPECT_EQ(mean_squared_error(a, b), mean_squared_error(b, a));
}

TEST(Measures, StayInRangeAtTheEnds) {
    for (int const side : {1, 5, 11, 33}) {
        Measures const m = measure(plain(side, side, {0, 0, 0}), plain(side, side, {255, 255, 255}));
        EXPECT_EQ(m.mse, 1);
        EXPECT_EQ(m.psnr, 0);
        EXPECT_GT(m.ssim, 0);
        EXPECT_LT(m.ssim, 0.01);
        EXPECT_GT(m.flip, 0.9);
        EXPECT_LE(m.flip, 1);
    }
    EXPECT_LE(measure(plain(20, 20, {0, 255, 0}), plain(20, 20, {0, 0, 255})).flip, 1);
}

TEST(Ratios, MedianAndSuitability) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> ratios;
    for (int i = 100; i >= 0; --i) {
        ratios.push_back(i / 50.0);
    }
    RatioSummary const many = summarise_ratios(ratios);
    EXPECT_NEAR(many.median, 1, 1e-12);
    EXPECT_NEAR(many.suitable, 100 * 51 / 101.0, 1e-9); // a ratio of 1 counts as suitable
    RatioSummary const two = summarise_ratios(std::vector<double>{2, 1});
    EXPECT_DOUBLE_EQ(two.median, 1.5);
    EXPECT_DOUBLE_EQ(two.suitable, 50);
    EXPECT_EQ(summarise_ratios(std::vector<double>{0, infinity, infinity}).median, infinity);
    EXPECT_THROW(summarise_ratios({}), InputError);
    EXPECT_THROW(summarise_ratios(std::vector<double>{0.5, NAN}), InputError);
    EXPECT_THROW(summarise_ratios(std::vector<double>{-1}), InputError);
}

TEST(Steadiness, AnErrorThatGrowsEvenlyIsSteady) {
    auto const flat = [](std::uint8_t level) {
        Picture picture(4, 4);
        std::fill(picture.rgba.begin(), picture.rgba.end(), level);
        return picture;
    };
    std::array const truth{flat(10), flat(20), flat(30)};
    EXPECT_EQ(unsteadiness({flat(20), flat(35), flat(50)}, truth), 0);
    EXPECT_NEAR(unsteadiness({flat(10), flat(71), flat(30)}, truth), 4 * 0.04, 1e-9) << "51 is a fifth, there and back";
}

} // namespace
} // namespace framelet::bench
