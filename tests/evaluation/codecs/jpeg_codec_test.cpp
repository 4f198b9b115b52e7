#include "tests/evaluation/codecs/jpeg_codec.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

Picture waves(int width, int height) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::uint8_t* const p = picture.row(y) + std::ptrdiff_t(x) * 4;
            p[0] = static_cast<std::uint8_t>(128 + 100 * std::sin(0.11 * x));
            p[1] = static_cast<std::uint8_t>(128 + 100 * std::sin(0.07 * y));
            p[2] = static_cast<std::uint8_t>(128 + 100 * std::sin(0.05 * (x + y)));
            p[3] = 255;
        }
    }
    return picture;
}

double mse(Picture const& a, Picture const& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        sum += (a.rgba[i] - b.rgba[i]) * (a.rgba[i] - b.rgba[i]);
    }
    return sum / static_cast<double>(a.rgba.size());
}

TEST(JpegCodec, ReturnsNearlyWhatItWasGiven) {
    Picture const picture = waves(101, 67);
    JpegCodec codec;
    Picture out;
    double last = 1e9;
    std::size_t last_size = 0;
    for (int const quality : {20, 60, 95}) {
        auto const bytes = codec.encode(picture, quality);
        codec.decode(bytes, out);
        ASSERT_EQ(out.width, 101);
        double const error = mse(picture, out);
        EXPECT_LT(error, last);
        EXPECT_GT(bytes.size(), last_size);
        last = error;
        last_size = bytes.size();
    }
    EXPECT_LT(last, 4);
    EXPECT_EQ(out.rgba[3], 255);
}

TEST(JpegCodec, RefusesDamagedBytes) {
    JpegCodec codec;
    Picture out;
    auto const bytes = codec.encode(waves(64, 64), 80);
    std::vector<std::byte> broken(bytes.begin(), bytes.end());
    broken.resize(broken.size() / 2);
    EXPECT_THROW(codec.decode(broken, out), InputError);
    EXPECT_THROW(codec.decode({}, out), InputError);
}

TEST(JpegRate, FitsItsBudgetFromEitherSide) {
    JpegCodec codec;
    Picture const picture = waves(256, 256);
    for (double const budget : {4000.0, 8000.0, 16000.0}) {
        JpegRate rate;
        std::size_t size = 0;
        int quality = 0;
        int before = 0;
        for (int frame = 0; frame < 40; ++frame) {
            before = quality;
            quality = rate.quality(budget);
            size = codec.encode(picture, quality).size();
            rate.took(quality, size);
        }
        EXPECT_LE(std::abs(quality - before), 2) << "settled";
        EXPECT_LE(static_cast<double>(size), 1.15 * budget) << quality;
        EXPECT_TRUE(static_cast<double>(size) >= 0.6 * budget || quality == JpegRate::best) << quality << ' ' << size;
    }
    EXPECT_EQ(JpegRate{}.quality(INFINITY), JpegRate::best);
}

} // namespace
} // namespace framelet::bench
