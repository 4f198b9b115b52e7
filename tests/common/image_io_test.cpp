#include "common/files/image_io.h"
#include "common/files/picture_writer.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet {
namespace {

TEST(ImageIo, RoundTripsAreExact) {
    Picture picture(237, 119); // of more pixels than are written at once
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 31);
    }
    auto const file = std::filesystem::temp_directory_path() / "framelet_image_io_test.png";
    write_png(file, picture);
    EXPECT_EQ(read_picture(file), picture);
    auto const plain = std::filesystem::path(file).replace_extension(".ppm");
    write_ppm(plain, picture);
    EXPECT_EQ(read_picture(plain), picture);
    std::filesystem::remove(plain);

    std::ifstream stream(file, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(read_picture(std::as_bytes(std::span(bytes)), "embedded.png"), picture);
    std::filesystem::remove(file);
}

TEST(ImageIo, FailuresNameTheFile) {
    for (auto const* name : {"/nonexistent/picture.png", "/nonexistent/map.hdr"}) {
        try {
            read_float_image(name);
            FAIL() << name;
        } catch (InputError const& error) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    for (auto const* name : {"/nonexistent/picture.png", "/dev/full"}) { // no folder, no room
        EXPECT_THROW(write_png(name, Picture(2, 2)), InputError) << name;
        EXPECT_THROW(write_ppm(name, Picture(2, 2)), InputError) << name;
    }
    EXPECT_THROW(read_picture(std::as_bytes(std::span("no image")), "garbage.png"), InputError);
}

TEST(ImageIo, TheSizeIsToldBeforeDecoding) {
    auto const folder = std::filesystem::temp_directory_path();
    write_png(folder / "framelet_size_test.png", Picture(37, 19));
    write_ppm(folder / "framelet_size_test.ppm", Picture(37, 19));
    for (auto const* name : {"framelet_size_test.png", "framelet_size_test.ppm"}) {
        int told = 0;
        EXPECT_THROW(read_picture(folder / name,
                                  [&](int width, int height) {
                                      told = width * 1000 + height;
                                      throw std::length_error("too large");
                                  }),
                     std::length_error);
        EXPECT_EQ(told, 37019) << name;
        std::filesystem::remove(folder / name);
    }
}

/// `count` bytes of a number, the least significant first.
std::string little(std::uint32_t value, std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) {
        bytes += static_cast<char>(value >> (8 * i));
    }
    return bytes;
}

/// No more than the headers of pictures of 9000x5000, which would take 180 MB: readers take it as they open such a
/// file.
std::vector<std::pair<std::string, std::string>> headers_of_large_pictures() {
    std::string const sides_big = "\x13\x88\x23\x28";
    std::string const comment("\xff\xfe\0\x04hi", 6);
    return {{"a.jpg", "\xff\xd8" + comment + std::string("\xff\xc2\0\x11\x08", 5) + sides_big + std::string(40, '\3')},
            {"animation.webp", "RIFF" + little(1000, 4) + "WEBPVP8X" + little(10, 4) + little(2, 4) + little(8999, 3) +
                                   little(4999, 3) + std::string(40, '\0')},
            {"lossless.webp", "RIFF" + little(1000, 4) + "WEBPVP8L" + little(900, 4) + "\x2f" +
                                  little(8999 | 4999 << 14, 4) + std::string(40, '\0')},
            {"lossy.webp", "RIFF" + little(1000, 4) + "WEBPVP8 " + little(900, 4) +
                               std::string("\0\0\0\x9d\x01\x2a", 6) + little(9000, 2) + little(5000, 2) +
                               std::string(40, '\0')},
            {"a.bmp", "BM" + little(1000, 4) + little(0, 4) + little(54, 4) + little(40, 4) + little(9000, 4) +
                          little(static_cast<std::uint32_t>(-5000), 4) + little(1, 2) + little(8, 2) + little(1, 4) +
                          std::string(20, '\0')},
            {"old.bmp", "BM" + little(1000, 4) + little(0, 4) + little(26, 4) + little(12, 4) + little(9000, 2) +
                            little(5000, 2) + little(1, 2) + little(24, 2)},
            {"a.tga", std::string("\0\0\x0b", 3) + std::string(9, '\0') + little(9000, 2) + little(5000, 2) + " \x08"}};
}

TEST(ImageIo, TheSizeIsToldBeforeAReaderOpensTheFile) {
    for (auto const& [name, bytes] : headers_of_large_pictures()) {
        std::pair<int, int> told;
        EXPECT_THROW(read_picture(std::as_bytes(std::span(bytes)), name,
                                  [&](int width, int height) {
                                      told = {width, height};
                                      throw std::length_error("too large");
                                  }),
                     std::length_error)
            << name;
        EXPECT_EQ(told, std::pair(9000, 5000)) << name;
        for (std::size_t const length : {std::size_t{4}, std::size_t{19}, bytes.size() / 2, bytes.size()}) {
            EXPECT_THROW(read_picture(std::as_bytes(std::span(bytes).first(length)), name), InputError)
                << name << ' ' << length;
        }
    }
}

TEST(ImageIo, EveryFormatOfScenesIsReadWhateverItsName) {
    auto const folder = std::filesystem::temp_directory_path();
    for (auto const* ending : {".jpg", ".webp", ".tga", ".bmp"}) {
        auto const file = folder / (std::string("framelet_format_test") + ending);
        auto const output = OIIO::ImageOutput::create(file.string());
        ASSERT_TRUE(output) << ending << OIIO::geterror();
        OIIO::ImageSpec const spec(37, 19, 3, OIIO::TypeDesc::UINT8);
        std::vector<std::uint8_t> texels;
        for (int i = 0; i < 37 * 19; ++i) {
            texels.insert(texels.end(), {200, 100, 50});
        }
        ASSERT_TRUE(output->open(file.string(), spec) && output->write_image(OIIO::TypeDesc::UINT8, texels.data()) &&
                    output->close());
        auto const disguised = folder / "framelet_format_test.png";
        std::filesystem::rename(file, disguised);
        std::pair<int, int> told;
        Picture const picture = read_picture(disguised, [&](int width, int height) { told = {width, height}; });
        std::filesystem::remove(disguised);
        EXPECT_EQ(told, std::pair(37, 19)) << ending;
        ASSERT_EQ(picture.rgba.size(), 37u * 19 * 4) << ending;
        EXPECT_NEAR(picture.rgba[0], 200, 4) << ending;
        EXPECT_NEAR(picture.rgba[1], 100, 4) << ending;
        EXPECT_NEAR(picture.rgba[2], 50, 4) << ending;
        EXPECT_EQ(picture.rgba[3], 255) << ending;
    }
}

/// The error's message. Nothing may be written to stderr meanwhile: only a library would do so.
std::string failure_of(std::string const& bytes, std::string const& name) {
    testing::internal::CaptureStderr();
    std::string line = "no error";
    try {
        read_picture(std::as_bytes(std::span(bytes)), name);
    } catch (InputError const& error) {
        line = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
    return line;
}

TEST(ImageIo, DamagedPngSaysOneLineAndNothingElse) {
    auto const file = std::filesystem::temp_directory_path() / "framelet_damaged_test.png";
    Picture picture(64, 64);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = static_cast<std::uint8_t>(i * i >> 5);
    }
    write_png(file, picture);
    std::ifstream stream(file, std::ios::binary);
    std::string const whole{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(file);
    std::string flipped = whole;
    flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 0x55);
    std::string no_size = whole;
    no_size.replace(16, 8, 8, '\0');
    for (std::string const& bytes : {flipped, no_size, whole.substr(0, whole.size() / 2), whole.substr(0, 9)}) {
        std::string const line = failure_of(bytes, "broken.png");
        EXPECT_NE(line.find("broken.png"), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    EXPECT_EQ(failure_of(whole, "whole.png"), "no error");
}

TEST(ImageIo, TexturesNobodyDecodesAreNamed) {
    std::string const rest(100, '\0');
    for (auto const* name : {"a.ktx2", "a.png"}) { // in a glTF without a media type it is taken for a PNG
        std::string const line = failure_of("\xabKTX 20\xbb\r\n\x1a\n" + rest, name);
        EXPECT_NE(line.find("KTX2 texture, which is not supported"), std::string::npos) << line;
    }
    EXPECT_NE(failure_of("sB" + rest, "a.basis").find("Basis Universal"), std::string::npos);
    std::string const gif = "GIF89a" + little(30000, 2) + little(30000, 2) + rest;
    EXPECT_NE(failure_of(gif, "a.gif").find("it is a GIF texture, which is not supported"), std::string::npos);
    EXPECT_NE(failure_of("#?RADIANCE\n\n-Y 1 +X 1\n" + rest, "a.png").find("Radiance HDR"), std::string::npos);
}

/// OpenImageIO would read outside its memory.
TEST(ImageIo, RunLengthsOfBmpAreRefused) {
    std::string bmp(80, '\0');
    bmp.replace(0, 2, "BM");
    bmp[10] = 54; // where pixels begin
    bmp[14] = 40;
    bmp[18] = bmp[22] = 2; // pixels in each direction
    bmp[26] = 1;
    bmp[28] = 24;
    EXPECT_EQ(failure_of(bmp, "a.bmp"), "no error");
    bmp[30] = 1;
    EXPECT_NE(failure_of(bmp, "a.bmp").find("run-length"), std::string::npos);
}

/// A TGA file of 2x2 pixels with a palette of so many colours, the first of which has this number. `pixels`: an entry
/// each, the lower row first.
std::string tga_with_palette(std::uint32_t first, std::uint32_t entries, std::uint32_t index_bits,
                             std::string const& pixels, bool is_packed = false, std::uint32_t entry_bits = 24) {
    std::string const colours = "abcdefghi";
    return std::string({'\0', '\1', is_packed ? '\x9' : '\1'}) + little(first, 2) + little(entries, 2) +
           little(entry_bits, 1) + little(0, 4) + little(2, 2) + little(2, 2) + little(index_bits, 2) +
           colours.substr(0, std::size_t{3} * entries) + pixels;
}

/// OpenImageIO would take what lies in memory beyond the palette, and so show it to viewers.
TEST(ImageIo, OfAPaletteNothingIsShownThatItDoesNotHave) {
    using namespace std::string_literals;
    std::string const plain = "\0\1\2\2"s, wide = "\0\0\1\0\2\0\2\0"s;
    std::string const packed = "\1\0\1\x85\2"s, packed_wide = "\1\0\0\1\0\x85\2\0"s; // a run leaves the picture
    for (std::string const& bytes :
         {tga_with_palette(0, 3, 8, plain), tga_with_palette(0, 3, 16, wide), tga_with_palette(0, 3, 8, packed, true),
          tga_with_palette(0, 3, 16, packed_wide, true)}) {
        Picture const picture = read_picture(std::as_bytes(std::span(bytes)), "a.tga");
        std::string const colours(picture.rgba.begin(), picture.rgba.end());
        EXPECT_EQ(colours, "ihg\377ihg\377cba\377fed\377");
    }
    for (std::string const& bytes :
         {tga_with_palette(1, 3, 8, plain), tga_with_palette(0xf000, 3, 8, plain), tga_with_palette(0, 2, 8, plain),
          tga_with_palette(0, 0, 8, plain), tga_with_palette(0, 2, 16, wide),
          tga_with_palette(0, 3, 16, "\0\0\0\1\0\0\0\0"s), tga_with_palette(0, 3, 24, wide + plain),
          tga_with_palette(0, 2, 8, packed, true), tga_with_palette(0, 2, 16, packed_wide, true),
          tga_with_palette(0, 3, 8, "\1\0\3\x81\2"s, true), tga_with_palette(0, 9, 8, plain, false, 8)}) {
        EXPECT_NE(failure_of(bytes, "a.tga").find("palette"), std::string::npos) << testing::PrintToString(bytes);
    }
}

} // namespace
} // namespace framelet
