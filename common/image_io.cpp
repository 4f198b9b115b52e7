#include "common/image_io.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "common/color.h"
#include "common/error.h"

namespace framelet {
namespace {

/// More pixels than this in one image are taken for a broken file.
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;

[[noreturn]] void fail(std::string const& name, std::string const& why) {
    std::string line = why.substr(0, why.find('\n'));
    throw InputError("cannot read image '" + name + "': " + (line.empty() ? "unknown or damaged format" : line));
}

std::unique_ptr<OIIO::ImageInput> open(std::string const& name, OIIO::Filesystem::IOMemReader* memory) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // colour where alpha is 0 is part of the texture
    if (memory) {
        OIIO::Filesystem::IOProxy* const proxy = memory;
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    }
    std::unique_ptr<OIIO::ImageInput> input;
    {
        // OpenImageIO 2.4 fills its tables of metadata fields (Exif, colour profiles) unguarded when it first needs
        // them (its issue 3756). Opening reads no more than headers; pixels are decoded side by side.
        static std::mutex opening;
        std::lock_guard const lock(opening);
        input = OIIO::ImageInput::open(name, &config, memory);
    }
    if (!input) {
        fail(name, OIIO::geterror());
    }
    OIIO::ImageSpec const& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 ||
        std::int64_t(spec.width) * spec.height > max_pixels) {
        fail(name, "its size " + std::to_string(spec.width) + "x" + std::to_string(spec.height) + " is out of range");
    }
    return input;
}

Picture read_rgba(std::string const& name, OIIO::Filesystem::IOMemReader* memory) {
    auto const input = open(name, memory);
    OIIO::ImageSpec const spec = input->spec();
    int const channels = std::min(spec.nchannels, 4);
    Picture picture(spec.width, spec.height);
    std::size_t const pixels = picture.rgba.size() / 4;
    std::vector<std::uint8_t> stored(pixels * static_cast<std::size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, stored.data())) {
        fail(name, input->geterror());
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        std::uint8_t const* in = &stored[i * static_cast<std::size_t>(channels)];
        std::uint8_t* out = &picture.rgba[i * 4];
        bool const grey = channels < 3;
        out[0] = in[0];
        out[1] = grey ? in[0] : in[1];
        out[2] = grey ? in[0] : in[2];
        out[3] = channels == 4 ? in[3] : channels == 2 ? in[1] : std::uint8_t(255);
    }
    return picture;
}

float finite(float value) {
    return value > 0 ? std::min(value, 65504.0f) : 0.0f;
}

} // namespace

Picture read_picture(std::filesystem::path const& file) {
    return read_rgba(file.string(), nullptr);
}

Picture read_picture(std::span<std::byte const> bytes, std::string const& name) {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    return read_rgba(name, &memory);
}

FloatImage read_float_image(std::filesystem::path const& file) {
    std::string const name = file.string();
    auto const input = open(name, nullptr);
    OIIO::ImageSpec const spec = input->spec();
    int const channels = std::min(spec.nchannels, 3);
    FloatImage image(spec.width, spec.height);
    std::vector<float> stored(image.rgb.size() * static_cast<std::size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, stored.data())) {
        fail(name, input->geterror());
    }
    bool const encoded = spec.format.basetype == OIIO::TypeDesc::UINT8;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        float const* in = &stored[i * static_cast<std::size_t>(channels)];
        Vec3 color = channels == 3 ? Vec3(in[0], in[1], in[2]) : Vec3(in[0]);
        for (int c = 0; c < 3; ++c) {
            color[c] = finite(encoded ? linear_from_srgb(color[c]) : color[c]);
        }
        image.rgb[i] = color;
    }
    return image;
}

} // namespace framelet
