#include "client/video/y4m.h"

#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

/// Y, Cb and Cr of a picture of this colour.
std::vector<int> coded(std::vector<std::uint8_t> const& rgb, YuvMatrix matrix) {
    Picture picture(1, 1);
    picture.rgba = {rgb[0], rgb[1], rgb[2], 255};
    std::string bytes;
    encode_y4m_picture(picture, matrix, bytes);
    EXPECT_EQ(bytes.size(), 6u + 3);
    std::vector<int> out;
    for (char const byte : bytes.substr(6)) {
        out.push_back(static_cast<std::uint8_t>(byte));
    }
    return out;
}

TEST(Y4m, HeaderSaysSizeAndRate) {
    EXPECT_EQ(y4m_header({131, 97}, PictureRate::of(59.94)),
              "YUV4MPEG2 W131 H97 F2997:50 Ip A1:1 C444 XCOLORRANGE=LIMITED\n");
}

TEST(Y4m, KnownColours) {
    for (YuvMatrix const matrix : {YuvMatrix::bt601, YuvMatrix::bt709}) {
        EXPECT_EQ(coded({0, 0, 0}, matrix), (std::vector<int>{16, 128, 128}));
        EXPECT_EQ(coded({255, 255, 255}, matrix), (std::vector<int>{235, 128, 128}));
    }
    EXPECT_EQ(coded({255, 0, 0}, YuvMatrix::bt601), (std::vector<int>{81, 90, 240}));
    EXPECT_EQ(coded({0, 255, 0}, YuvMatrix::bt601), (std::vector<int>{145, 54, 34}));
    EXPECT_EQ(coded({0, 0, 255}, YuvMatrix::bt601), (std::vector<int>{41, 240, 110}));
    EXPECT_EQ(coded({255, 0, 0}, YuvMatrix::bt709), (std::vector<int>{63, 102, 240}));
    EXPECT_EQ(coded({0, 255, 0}, YuvMatrix::bt709), (std::vector<int>{173, 42, 26}));
    EXPECT_EQ(coded({0, 0, 255}, YuvMatrix::bt709), (std::vector<int>{32, 240, 118}));
}

TEST(Y4m, PlanesFollowEachOtherInRasterOrder) {
    Picture picture(2, 2);
    for (std::size_t i = 0; i < 4; ++i) {
        picture.rgba[4 * i] = picture.rgba[4 * i + 1] = picture.rgba[4 * i + 2] = static_cast<std::uint8_t>(85 * i);
    }
    std::string bytes = "what was there before";
    encode_y4m_picture(picture, YuvMatrix::bt709, bytes);
    EXPECT_EQ(bytes, "FRAME\n" + std::string("\x10\x59\xa2\xeb", 4) + std::string(8, '\x80'));
}

TEST(Y4m, MatrixIsWhatPlayersTakeForThatSize) {
    EXPECT_EQ(yuv_matrix({1279, 576}), YuvMatrix::bt601);
    EXPECT_EQ(yuv_matrix({1280, 576}), YuvMatrix::bt709);
    EXPECT_EQ(yuv_matrix({1024, 768}), YuvMatrix::bt709);
}

} // namespace
} // namespace framelet
