#include "common/files/exr.h"

#include <array>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include "common/color.h"
#include "common/error.h"

namespace framelet {
namespace {

/// The library takes values that may be written to, for reading as well; it only reads these.
Imf::Slice slice_of(std::vector<float> const& values, int width) {
    char* const first = reinterpret_cast<char*>(const_cast<float*>(values.data()));
    return {Imf::FLOAT, first, sizeof(float), sizeof(float) * static_cast<std::size_t>(width)};
}

} // namespace

std::string exr_bytes(Picture const& picture, std::vector<float> const& depths) {
    FloatImage linear(picture.width, picture.height);
    for (std::size_t i = 0; i < linear.rgb.size(); ++i) {
        std::uint8_t const* const pixel = picture.rgba.data() + 4 * i;
        linear.rgb[i] = {linear_from_srgb_byte(pixel[0]), linear_from_srgb_byte(pixel[1]),
                         linear_from_srgb_byte(pixel[2])};
    }
    return exr_bytes(linear, depths);
}

std::string exr_bytes(FloatImage const& radiance, std::vector<float> const& depths) {
    std::size_t const pixels = radiance.rgb.size();
    FRAMELET_CHECK(depths.empty() || depths.size() == pixels);
    Imf::Header header(radiance.width, radiance.height);
    header.compression() = Imf::NO_COMPRESSION;
    Imf::FrameBuffer values;
    auto const add = [&](char const* name, std::vector<float> const& channel) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        values.insert(name, slice_of(channel, radiance.width));
    };
    std::array<std::vector<float>, 3> colours;
    for (std::size_t channel = 0; channel < colours.size(); ++channel) {
        for (Vec3 const& pixel : radiance.rgb) {
            colours[channel].push_back(pixel[static_cast<int>(channel)]);
        }
        add(std::array{"R", "G", "B"}[channel], colours[channel]);
    }
    if (!depths.empty()) {
        add("Z", depths);
    }
    Imf::StdOSStream out;
    {
        Imf::OutputFile file(out, header, 0); // threads: none but this
        file.setFrameBuffer(values);
        file.writePixels(radiance.height);
    }
    return out.str();
}

} // namespace framelet
