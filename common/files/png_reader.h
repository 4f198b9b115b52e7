// Reads PNG files in memory through libpng: OpenImageIO's reader lets libpng print lines of its own. In: a file's
// bytes. Out: a picture as `read_picture` promises, or a PngError with the reason.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>

#include "common/files/size_check.h"
#include "common/image.h"

namespace framelet {

struct PngError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

Picture read_png(std::span<std::byte const> bytes, SizeCheck const& check);

} // namespace framelet
