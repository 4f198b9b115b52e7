#include "common/files/png_reader.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include <png.h>

namespace framelet {
namespace {

/// The bytes left to read, and the library's message about a failure.
struct Source {
    std::span<std::byte const> left;
    char complaint[120] = "";
};

void complain(png_structp png, png_const_charp text) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    std::snprintf(source.complaint, sizeof(source.complaint), "%s", text);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep out, std::size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.left.size()) {
        png_error(png, "the file is truncated");
    }
    std::memcpy(out, source.left.data(), count);
    source.left = source.left.subspan(count);
}

struct Reader {
    explicit Reader(Source& source)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, complain, ignore)),
          info(png != nullptr ? png_create_info_struct(png) : nullptr) {
        if (info == nullptr) {
            png_destroy_read_struct(&png, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png, &source, take);
    }
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    Reader(Reader const&) = delete;
    Reader& operator=(Reader const&) = delete;

    png_structp png;
    png_infop info;
};

/// Reads the header and asks for 8-bit RGBA, values as stored; false where that failed. Nothing here has a destructor:
/// failures jump.
bool read_header(Reader const& reader) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) {
        return false;
    }
    png_read_info(reader.png, reader.info);
    png_set_expand(reader.png);
    png_set_scale_16(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_set_add_alpha(reader.png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool read_rows(Reader const& reader, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) {
        return false;
    }
    png_read_image(reader.png, rows);
    return true;
}

} // namespace

Picture read_png(std::span<std::byte const> bytes, SizeCheck const& check) {
    Source source{bytes};
    Reader const reader(source);
    if (!read_header(reader)) {
        throw PngError(source.complaint);
    }
    auto const width = static_cast<int>(png_get_image_width(reader.png, reader.info));
    auto const height = static_cast<int>(png_get_image_height(reader.png, reader.info));
    check(width, height);
    Picture picture(width, height);
    std::vector<png_bytep> rows(static_cast<std::size_t>(height));
    for (std::size_t y = 0; y < rows.size(); ++y) {
        rows[y] = &picture.rgba[y * static_cast<std::size_t>(width) * 4];
    }
    if (!read_rows(reader, rows.data())) {
        throw PngError(source.complaint);
    }
    return picture;
}

} // namespace framelet
