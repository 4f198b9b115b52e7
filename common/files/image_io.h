// Reads image files through OpenImageIO and libpng. Every failure is an InputError that names the file.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/files/size_check.h"
#include "common/image.h"

namespace framelet {

/// Reads PNG, JPEG, WebP, TGA, BMP or PNM as 8-bit RGBA, values as stored (no colour conversion, ICC and gAMA ignored),
/// told apart by what is in the file. Grey is replicated to RGB; missing alpha is 255; 16-bit is rounded to 8. Of an
/// animation the first picture is read. `check` is told the size before memory is taken for that many pixels.
Picture read_picture(std::filesystem::path const& file, SizeCheck const& check = {});

/// The same from a file that is in memory (an image embedded in a scene file); `name` is for messages.
Picture read_picture(std::span<std::byte const> bytes, std::string const& name, SizeCheck const& check = {});

/// Reads a linear float picture (.hdr, .exr; those of `read_picture` are sRGB-decoded where they have 8 bits). NaN, Inf
/// and negatives become finite >= 0. `check` as above.
FloatImage read_float_image(std::filesystem::path const& file, SizeCheck const& check = {});

} // namespace framelet
