// Tests EXR files by reading them with another library.
#include "common/files/exr.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/color.h"
#include "common/files/picture_writer.h"

namespace framelet {
namespace {

/// All channels, interleaved, and their names.
struct Read {
    int width = 0, height = 0;
    std::vector<std::string> names;
    std::vector<float> values;

    float value(std::string const& name, int x, int y) const {
        auto const channel = std::find(names.begin(), names.end(), name) - names.begin();
        return values[(static_cast<std::size_t>(y) * width + x) * names.size() + channel];
    }
};

/// Reads what `write_exr` makes of these.
template <class... Contents>
Read read_back(Contents const&... contents) {
    auto const file = std::filesystem::temp_directory_path() / ("framelet_exr_test_" + std::to_string(::getpid()));
    auto const named = std::filesystem::path(file).replace_extension(".exr");
    write_exr(named, contents...);
    auto const input = OIIO::ImageInput::open(named.string());
    Read out;
    EXPECT_TRUE(input) << OIIO::geterror();
    if (input) {
        OIIO::ImageSpec const& spec = input->spec();
        EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
        out = {spec.width, spec.height, spec.channelnames, {}};
        out.values.resize(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
        EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, out.values.data()))
            << input->geterror();
    }
    std::filesystem::remove(named);
    return out;
}

Picture coloured(int width, int height) {
    Picture out(width, height);
    for (std::size_t i = 0; i < out.rgba.size(); ++i) {
        out.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 31);
    }
    return out;
}

TEST(Exr, HasLinearColourAndDepth) {
    Picture const picture = coloured(7, 5);
    std::vector<float> depths(35);
    for (std::size_t i = 0; i < depths.size(); ++i) {
        depths[i] = 0.25f * static_cast<float>(i);
    }
    depths[3] = std::numeric_limits<float>::infinity();
    Read const read = read_back(picture, depths);
    ASSERT_EQ(read.width, 7);
    ASSERT_EQ(read.height, 5);
    ASSERT_EQ(read.names.size(), 4u);
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 7; ++x) {
            std::uint8_t const* const pixel = picture.row(y) + 4 * x;
            EXPECT_EQ(read.value("R", x, y), linear_from_srgb_byte(pixel[0]));
            EXPECT_EQ(read.value("G", x, y), linear_from_srgb_byte(pixel[1]));
            EXPECT_EQ(read.value("B", x, y), linear_from_srgb_byte(pixel[2]));
            EXPECT_EQ(read.value("Z", x, y), depths[static_cast<std::size_t>(y * 7 + x)]);
        }
    }
}

TEST(Exr, HasNoDepthWhereNoneIsKnown) {
    Read const read = read_back(coloured(1, 1), std::vector<float>{});
    EXPECT_EQ(read.names, (std::vector<std::string>{"R", "G", "B"}));
}

TEST(Exr, KeepsRadianceAboveWhite) {
    FloatImage radiance(2, 1);
    radiance.at(0, 0) = {0, 0.25f, 1e6f};
    radiance.at(1, 0) = {3, 2, 1};
    Read const read = read_back(radiance);
    ASSERT_EQ(read.names, (std::vector<std::string>{"R", "G", "B"}));
    for (int x = 0; x < 2; ++x) {
        EXPECT_EQ(Vec3(read.value("R", x, 0), read.value("G", x, 0), read.value("B", x, 0)), radiance.at(x, 0));
    }
}

} // namespace
} // namespace framelet
