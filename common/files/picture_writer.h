// Pictures out: PNG files through libpng, or PPM files, which cost nothing to make. The thin programs need no more of
// an image library.
#pragma once

#include <filesystem>

#include "common/image.h"

namespace framelet {

/// Writes RGB (alpha dropped), marked as sRGB. Throws InputError, which names the file.
void write_png(std::filesystem::path const& file, Picture const& picture);

/// The same without compression (binary PPM, "P6").
void write_ppm(std::filesystem::path const& file, Picture const& picture);

} // namespace framelet
