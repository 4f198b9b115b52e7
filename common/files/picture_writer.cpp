#include "common/files/picture_writer.h"

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <png.h>

#include "common/error.h"
#include "common/files/exr.h"

namespace framelet {
namespace {

/// The library's message about a failure.
struct Complaint {
    char text[120] = "";
};

void complain(png_structp png, png_const_charp text) {
    auto& complaint = *static_cast<Complaint*>(png_get_error_ptr(png));
    std::snprintf(complaint.text, sizeof(complaint.text), "%s", text);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

struct Writer {
    explicit Writer(Complaint& complaint)
        : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, complain, ignore)),
          info(png != nullptr ? png_create_info_struct(png) : nullptr) {
        if (info == nullptr) {
            png_destroy_write_struct(&png, nullptr);
            throw std::bad_alloc();
        }
    }
    ~Writer() { png_destroy_write_struct(&png, &info); }
    Writer(Writer const&) = delete;
    Writer& operator=(Writer const&) = delete;

    png_structp png;
    png_infop info;
};

/// Writes the whole PNG file; false where that failed. Nothing here has a destructor: failures jump.
bool write_all(Writer const& writer, std::FILE* stream, Picture const& picture) {
    constexpr int compression_level = 3; // pictures of a moving scene are written as they are shown
    if (setjmp(png_jmpbuf(writer.png)) != 0) {
        return false;
    }
    png_init_io(writer.png, stream);
    png_set_compression_level(writer.png, compression_level);
    png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(writer.png, writer.info);
    png_set_filler(writer.png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < picture.height; ++y) {
        png_write_row(writer.png, picture.row(y));
    }
    png_write_end(writer.png, writer.info);
    return true;
}

InputError failure(std::filesystem::path const& file, std::string const& why) {
    return InputError("cannot write image '" + file.string() + "': " + why);
}

/// Opens the file, lets `write` fill it (which returns the text of a failure, or none) and closes it again. Throws
/// InputError, which names the file.
template <typename Write>
void write_file(std::filesystem::path const& file, Write const& write) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "wb"), std::fclose);
    if (!stream) {
        throw failure(file, std::strerror(errno));
    }
    std::string const why = write(stream.get());
    if (!why.empty()) {
        throw failure(file, why);
    }
    if (std::fclose(stream.release()) != 0) {
        throw failure(file, std::strerror(errno));
    }
}

void write_content(std::filesystem::path const& file, std::string const& content) {
    write_file(file, [&](std::FILE* stream) -> std::string {
        return std::fwrite(content.data(), 1, content.size(), stream) == content.size() ? "" : std::strerror(errno);
    });
}

} // namespace

void write_png(std::filesystem::path const& file, Picture const& picture) {
    write_file(file, [&](std::FILE* stream) -> std::string {
        Complaint complaint;
        Writer const writer(complaint);
        return write_all(writer, stream, picture) ? "" : complaint.text;
    });
}

void write_ppm(std::filesystem::path const& file, Picture const& picture) {
    constexpr std::size_t channels = 3;
    constexpr std::size_t at_once = 16384; // pixels: what is written stays in the cache of the processor
    write_file(file, [&](std::FILE* stream) -> std::string {
        std::fprintf(stream, "P6\n%d %d\n255\n", picture.width, picture.height);
        std::vector<std::uint8_t> colors;
        std::size_t const pixels = picture.rgba.size() / 4;
        for (std::size_t begin = 0; begin < pixels; begin += at_once) {
            std::size_t const end = std::min(pixels, begin + at_once);
            colors.resize(channels * (end - begin));
            for (std::size_t i = begin; i < end; ++i) {
                std::copy_n(&picture.rgba[4 * i], channels, &colors[channels * (i - begin)]);
            }
            if (std::fwrite(colors.data(), 1, colors.size(), stream) != colors.size()) {
                break;
            }
        }
        return std::ferror(stream) == 0 ? "" : std::strerror(errno);
    });
}

void write_exr(std::filesystem::path const& file, Picture const& picture, std::vector<float> const& depths) {
    write_content(file, exr_bytes(picture, depths));
}

void write_exr(std::filesystem::path const& file, FloatImage const& radiance) {
    write_content(file, exr_bytes(radiance));
}

} // namespace framelet
