// Pictures out, as PNG files, through libpng: the thin programs need no more of an image library.
#pragma once

#include <filesystem>

#include "common/image.h"

namespace framelet {

/// Writes RGB (alpha dropped), marked as sRGB. Throws InputError, which names the file.
void write_png(std::filesystem::path const& file, Picture const& picture);

} // namespace framelet
