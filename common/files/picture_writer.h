// Writes pictures: PNG files through libpng, PPM files, which cost nothing to make, or EXR files with depth. The thin
// programs need no more of an image library.
#pragma once

#include <filesystem>
#include <vector>

#include "common/image.h"

namespace framelet {

/// Writes RGB (alpha dropped), marked as sRGB. Throws InputError, which names the file.
void write_png(std::filesystem::path const& file, Picture const& picture);

/// The same without compression (binary PPM, "P6").
void write_ppm(std::filesystem::path const& file, Picture const& picture);

/// Writes linear light with the depth of each pixel, in the form of `exr_bytes`. Throws InputError, which names the
/// file.
void write_exr(std::filesystem::path const& file, Picture const& picture, std::vector<float> const& depths);

/// Writes radiance, not limited to [0, 1]. Throws InputError, which names the file.
void write_exr(std::filesystem::path const& file, FloatImage const& radiance);

} // namespace framelet
