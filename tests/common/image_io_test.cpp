#include "common/files/image_io.h"
#include "common/files/picture_writer.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet {
namespace {

TEST(ImageIo, RoundTripsAreExact) {
    Picture picture(37, 19);
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
}

} // namespace
} // namespace framelet
