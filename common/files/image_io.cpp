#include "common/files/image_io.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "common/color.h"
#include "common/error.h"
#include "common/files/png_reader.h"

namespace framelet {
namespace {

/// More pixels than this in one image are taken for a broken file.
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;

[[noreturn]] void fail(std::string const& name, std::string const& why) {
    std::string line = why.substr(0, why.find('\n'));
    throw InputError("cannot read image '" + name + "': " + (line.empty() ? "unknown or damaged format" : line));
}

void check_size(std::string const& name, int width, int height) {
    if (width < 1 || height < 1 || std::int64_t(width) * height > max_pixels) {
        fail(name, "its size " + std::to_string(width) + "x" + std::to_string(height) + " is out of range");
    }
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
    check_size(name, spec.width, spec.nchannels < 1 ? 0 : spec.height);
    return input;
}

/// Refuses formats that scenes use for compressed textures and that nothing here decodes; throws InputError.
void check_format(std::span<std::byte const> start, std::string const& name) {
    constexpr std::pair<std::string_view, char const*> refused[] = {
        {"\xabKTX 20", "KTX2"}, {"\xabKTX 11", "KTX"}, {"sB", "Basis Universal"}};
    std::string_view const text(reinterpret_cast<char const*>(start.data()), start.size());
    for (auto const& [signature, format] : refused) {
        if (text.starts_with(signature)) {
            fail(name, std::string("it is a ") + format + " texture, which is not supported; PNG, JPEG and WebP are");
        }
    }
}

Picture read_rgba(std::string const& name, OIIO::Filesystem::IOMemReader* memory, SizeCheck const& check) {
    auto const input = open(name, memory);
    OIIO::ImageSpec const spec = input->spec();
    check(spec.width, spec.height);
    int const channels = std::min(spec.nchannels, 4);
    Picture picture(spec.width, spec.height);
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, picture.rgba.data(), 4)) {
        fail(name, input->geterror());
    }
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        std::uint8_t* const pixel = &picture.rgba[i];
        pixel[3] = channels == 4 ? pixel[3] : channels == 2 ? pixel[1] : std::uint8_t(255);
        if (channels < 3) {
            pixel[1] = pixel[0];
            pixel[2] = pixel[0];
        }
    }
    return picture;
}

Picture read_named_png(std::span<std::byte const> bytes, std::string const& name, SizeCheck const& check) {
    try {
        return read_png(bytes, [&](int width, int height) {
            check_size(name, width, height);
            check(width, height);
        });
    } catch (PngError const& error) {
        fail(name, error.what());
    }
}

/// The file's first bytes, up to `most`; none where it cannot be read.
std::vector<std::byte> read_start(std::filesystem::path const& file, std::uintmax_t most) {
    std::error_code code;
    std::uintmax_t const size = std::filesystem::file_size(file, code);
    std::vector<std::byte> bytes(code ? 0 : static_cast<std::size_t>(std::min(size, most)));
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return bytes;
}

void accept_any_size(int, int) {}

float finite(float value) {
    return value > 0 ? std::min(value, 65504.0f) : 0.0f;
}

} // namespace

Picture read_picture(std::filesystem::path const& file, SizeCheck const& check) {
    constexpr std::uintmax_t signature_bytes = 16;
    std::vector<std::byte> const start = read_start(file, signature_bytes);
    if (is_png(start)) {
        return read_picture(read_start(file, std::numeric_limits<std::uintmax_t>::max()), file.string(), check);
    }
    check_format(start, file.string());
    return read_rgba(file.string(), nullptr, check ? check : accept_any_size);
}

Picture read_picture(std::span<std::byte const> bytes, std::string const& name, SizeCheck const& check) {
    if (is_png(bytes)) {
        return read_named_png(bytes, name, check ? check : accept_any_size);
    }
    check_format(bytes, name);
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    return read_rgba(name, &memory, check ? check : accept_any_size);
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
