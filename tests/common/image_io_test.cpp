#include "common/image_io.h"
#include "common/picture_writer.h"

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

} // namespace
} // namespace framelet
