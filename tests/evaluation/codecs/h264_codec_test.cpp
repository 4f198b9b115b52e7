#include "tests/evaluation/codecs/h264_codec.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

Picture waves(int width, int height, double time) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::uint8_t* const p = picture.row(y) + std::ptrdiff_t(x) * 4;
            p[0] = static_cast<std::uint8_t>(128 + 80 * std::sin(0.11 * (x + 90 * time)));
            p[1] = static_cast<std::uint8_t>(128 + 80 * std::sin(0.07 * y));
            p[2] = static_cast<std::uint8_t>(128 + 80 * std::sin(0.05 * (x + y)));
            p[3] = 255;
        }
    }
    return picture;
}

TEST(H264Codec, MovingPicturesComeOutAtOnceAndAlike) {
    for (auto const& [width, height] : {std::pair{192, 128}, std::pair{97, 65}}) {
        H264Encoder encoder(width, height, 30);
        H264Decoder decoder;
        Picture out(width, height);
        for (int i = 0; i < 12; ++i) {
            Picture const picture = waves(width, height, i / 30.0);
            decoder.decode(encoder.encode(picture, INFINITY), out);
            ASSERT_EQ(out.width, width);
            ASSERT_EQ(out.height, height);
            EXPECT_GT(psnr_from_mse(mean_squared_error(picture, out)), 45) << i;
        }
    }
}

TEST(H264Codec, KeepsPrimaryColors) {
    for (auto const color : {std::array{255, 0, 0}, std::array{0, 255, 0}, std::array{0, 0, 255},
                             std::array{255, 255, 255}, std::array{0, 0, 0}, std::array{200, 120, 40}}) {
        Picture picture(64, 64);
        for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
            picture.rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 255 : color[i % 4]);
        }
        H264Encoder encoder(64, 64, 30);
        Picture out(64, 64);
        H264Decoder().decode(encoder.encode(picture, INFINITY), out);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(out.row(32)[32 * 4 + c], color[c], 4) << color[0] << ' ' << color[1] << ' ' << color[2];
        }
    }
}

TEST(H264Codec, TheSamePicturesGiveTheSameBytesAndNoFrameTakesMoreThanItMay) {
    H264Encoder a(256, 192, 30), b(256, 192, 30);
    for (int i = 0; i < 90; ++i) {
        Picture const picture = waves(256, 192, i / 30.0);
        double const most_bytes = i < 30 ? 3000 : i < 60 ? 700 : 2000; // as for a link whose rate changes
        auto const unit = a.encode(picture, most_bytes);
        EXPECT_EQ(unit, b.encode(picture, most_bytes));
        if (i % 30 > 2) {
            EXPECT_LT(static_cast<double>(unit.size()), 1.3 * most_bytes) << i;
            EXPECT_GT(static_cast<double>(unit.size()), 0.4 * most_bytes) << i;
        }
    }
}

TEST(H264Codec, RefusesDamagedBytes) {
    Picture out;
    H264Decoder decoder;
    EXPECT_THROW(decoder.decode({}, out), InputError);
    std::vector<std::byte> const garbage(300, std::byte{0x5a});
    EXPECT_THROW(decoder.decode(garbage, out), InputError);
}

} // namespace
} // namespace framelet::bench
