// Combines several pictures into one, to be looked at side by side.
#pragma once

#include <filesystem>
#include <span>

#include "common/image.h"

namespace framelet::bench {

/// Factor by which an error is multiplied before it is drawn: errors of 255 / 4 and more are white.
inline constexpr int error_gain = 4;

/// Sheet with a column for the reference and one for each of `shown`, in their order; below each of these the root mean
/// square of its three bytes' differences from the reference, times `error_gain`, in grey. White between them. Throws
/// InputError where they differ in size or are empty.
Picture beside_reference(Picture const& reference, std::span<Picture const> shown);

/// Writes that sheet as a PNG file, into a folder that is made where there is none.
void write_beside_reference(std::filesystem::path const& file, Picture const& reference,
                            std::span<Picture const> shown);

} // namespace framelet::bench
