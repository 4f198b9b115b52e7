#include "common/files/image_io.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "common/color.h"
#include "common/error.h"
#include "common/files/picture_header.h"
#include "common/files/png_reader.h"
#include "common/files/regular_file.h"
#include "common/files/tga_palette.h"

namespace framelet {
namespace {

/// More pixels than this in one image are taken for a broken file.
constexpr std::int64_t max_pixels = std::int64_t(1) << 28;

[[noreturn]] void fail(std::string const& name, std::string const& why) {
    std::string line = why.substr(0, why.find('\n'));
    throw InputError("cannot read image '" + name + "': " + (line.empty() ? "unknown or damaged format" : line));
}

void check_size(std::string const& name, PictureSize size) {
    if (size.width < 1 || size.height < 1 || size.width > max_pixels / size.height) {
        fail(name, "its size " + std::to_string(size.width) + "x" + std::to_string(size.height) + " is out of range");
    }
}

/// Says in one line that it is nothing that is read here. `format`: what it is, null where nobody knows.
[[noreturn]] void refuse_format(std::string const& name, char const* format, bool is_sky = false) {
    char const* const known = is_sky ? " picture, which is not supported; HDR, EXR, PNG and JPEG are"
                                     : " texture, which is not supported; PNG, JPEG, WebP, TGA and BMP are";
    fail(name, format == nullptr ? std::string() : std::string("it is a ") + format + known);
}

/// Name of OpenImageIO's reader of a format.
char const* reader_name(PictureFormat format) {
    switch (format) {
    case PictureFormat::png:
        return "png";
    case PictureFormat::jpeg:
        return "jpeg";
    case PictureFormat::webp:
        return "webp";
    case PictureFormat::tga:
        return "targa";
    case PictureFormat::bmp:
        return "bmp";
    case PictureFormat::pnm:
        return "pnm";
    case PictureFormat::hdr:
        return "hdr";
    case PictureFormat::exr:
        break;
    }
    return "openexr";
}

/// True for formats whose reader may take memory for all pixels as it opens a file.
bool decodes_as_it_opens(PictureFormat format) {
    return format == PictureFormat::jpeg || format == PictureFormat::webp || format == PictureFormat::bmp ||
           format == PictureFormat::tga;
}

/// True for a BMP whose header says so. OpenImageIO 2.4 reads outside its memory where such a picture is broken.
bool is_run_length_coded(std::span<std::byte const> bmp) {
    constexpr std::size_t header_bytes = 14, compression = 30; // 32 bits each, the lowest byte first
    bool const has_compression = bmp.size() > compression && bmp[header_bytes] != std::byte{12}; // the first version
    return has_compression && (bmp[compression] == std::byte{1} || bmp[compression] == std::byte{2});
}

/// A file in memory. OpenImageIO 2.4's own reads beyond the end of what it has where it is asked to begin there.
class MemoryFile : public OIIO::Filesystem::IOMemReader {
public:
    using IOMemReader::IOMemReader;

    std::size_t pread(void* to, std::size_t bytes, std::int64_t offset) override {
        bool const begins = offset >= 0 && static_cast<std::size_t>(offset) < size();
        return begins ? IOMemReader::pread(to, bytes, offset) : 0;
    }
};

/// A picture in memory that OpenImageIO reads, opened once `check` has been told its size.
class OpenedPicture {
public:
    OpenedPicture(std::span<std::byte const> bytes, PictureFormat format, std::string const& name,
                  SizeCheck const& check)
        : memory_(const_cast<std::byte*>(bytes.data()), bytes.size()), name_(name) {
        PictureSize size;
        auto const tell = [&](std::optional<PictureSize> const& found) {
            size = found.value_or(PictureSize{});
            check_size(name, size);
            check(static_cast<int>(size.width), static_cast<int>(size.height));
        };
        bool const is_told_first = decodes_as_it_opens(format);
        if (is_told_first) {
            tell(header_size(format, bytes));
        }
        if (format == PictureFormat::bmp && is_run_length_coded(bytes)) {
            fail(name, "it is a BMP with run-length coding, which is not read: save it without, or as PNG");
        }
        if (char const* const problem = format == PictureFormat::tga ? tga_palette_problem(bytes) : nullptr) {
            fail(name, problem);
        }
        open(reader_name(format));
        PictureSize const opened{spec().width, spec().nchannels < 1 ? 0 : spec().height};
        if (!is_told_first) {
            tell(opened);
        }
        if (opened != size) {
            fail(name, "its header has two sizes");
        }
    }

    OIIO::ImageSpec const& spec() const { return input_->spec(); }

    /// Reads the first channels of all pixels, `pixel_bytes` apart. All but OpenEXR, which may be in tiles, row by row:
    /// OpenImageIO takes memory for 64 rows at least when it is asked for all, even where the picture has one.
    void read(int channels, OIIO::TypeDesc type, void* out, std::size_t pixel_bytes) {
        OIIO::ImageSpec const& s = spec();
        if (input_->format_name() == std::string_view("openexr")) {
            auto const stride = static_cast<OIIO::stride_t>(pixel_bytes);
            contained([&] { return input_->read_image(0, 0, 0, channels, type, out, stride); });
            return;
        }
        std::size_t const taken = static_cast<std::size_t>(channels) * type.size();
        std::size_t const stored = static_cast<std::size_t>(s.nchannels) * type.size();
        std::vector<std::byte> row(static_cast<std::size_t>(s.width) * stored);
        auto* to = static_cast<std::byte*>(out);
        for (int y = s.y; y < s.y + s.height; ++y) {
            contained([&] { return input_->read_scanline(y, s.z, type, row.data()); });
            for (std::byte const* from = row.data(); from != row.data() + row.size(); from += stored) {
                std::memcpy(to, from, taken);
                to += pixel_bytes;
            }
        }
    }

private:
    void open(char const* reader) {
        // OpenImageIO 2.4 fills its tables of metadata fields (Exif, colour profiles) unguarded when it first needs
        // them (its issue 3756).
        static std::mutex opening;
        std::lock_guard const lock(opening);
        // It takes memory for so many rows at least, even where the picture has fewer.
        OIIO::attribute("read_chunk", 1);
        input_ = OIIO::ImageInput::create(reader);
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1); // colour where alpha is 0 is part of the texture
        if (!input_ || !input_->set_ioproxy(&memory_)) {
            fail(name_, std::string("OpenImageIO was built without a reader of ") + reader);
        }
        contained([&] { return input_->open(name_, spec, config); });
    }

    /// Calls a reader. A size that it believed and for which there can be no memory is a failure of the picture.
    void contained(auto const& call) {
        try {
            if (call()) {
                return;
            }
        } catch (std::length_error const& error) {
            fail(name_, error.what());
        }
        fail(name_, input_->geterror());
    }

    MemoryFile memory_;
    std::string const name_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

Picture read_rgba(std::span<std::byte const> bytes, PictureFormat format, std::string const& name,
                  SizeCheck const& check) {
    OpenedPicture opened(bytes, format, name, check);
    OIIO::ImageSpec const& spec = opened.spec();
    int const channels = std::min(spec.nchannels, 4);
    Picture picture(spec.width, spec.height);
    opened.read(channels, OIIO::TypeDesc::UINT8, picture.rgba.data(), 4);
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
            check_size(name, {width, height});
            check(width, height);
        });
    } catch (PngError const& error) {
        fail(name, error.what());
    }
}

std::vector<std::byte> read_bytes(std::filesystem::path const& file) {
    RegularFile const opened(file);
    std::vector<std::byte> bytes(static_cast<std::size_t>(opened.bytes()));
    if (!opened || !opened.read(bytes.data(), bytes.size())) {
        fail(file.string(), "the file cannot be read");
    }
    return bytes;
}

void accept_any_size(int, int) {}

float finite(float value) {
    return value > 0 ? std::min(value, 65504.0f) : 0.0f;
}

} // namespace

Picture read_picture(std::filesystem::path const& file, SizeCheck const& check) {
    return read_picture(read_bytes(file), file.string(), check);
}

Picture read_picture(std::span<std::byte const> bytes, std::string const& name, SizeCheck const& check) {
    SizeCheck const& told = check ? check : accept_any_size;
    std::optional<PictureFormat> const format = picture_format(bytes);
    if (!format) {
        refuse_format(name, foreign_format(bytes));
    }
    if (*format == PictureFormat::hdr || *format == PictureFormat::exr) {
        refuse_format(name, *format == PictureFormat::hdr ? "Radiance HDR" : "OpenEXR"); // of a scene, not of its sky
    }
    return *format == PictureFormat::png ? read_named_png(bytes, name, told) : read_rgba(bytes, *format, name, told);
}

FloatImage read_float_image(std::filesystem::path const& file, SizeCheck const& check) {
    std::string const name = file.string();
    std::vector<std::byte> const bytes = read_bytes(file);
    std::optional<PictureFormat> const format = picture_format(bytes);
    if (!format) {
        refuse_format(name, foreign_format(bytes), true);
    }
    OpenedPicture opened(bytes, *format, name, check ? check : accept_any_size);
    OIIO::ImageSpec const& spec = opened.spec();
    int const channels = std::min(spec.nchannels, 3);
    FloatImage image(spec.width, spec.height);
    std::vector<float> stored(image.rgb.size() * static_cast<std::size_t>(channels));
    opened.read(channels, OIIO::TypeDesc::FLOAT, stored.data(), static_cast<std::size_t>(channels) * sizeof(float));
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
