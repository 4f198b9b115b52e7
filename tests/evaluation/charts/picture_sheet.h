// Combines several pictures into one, to be looked at side by side.
#pragma once

#include <filesystem>
#include <span>

#include "common/image.h"

namespace framelet::bench {

/// Sheet of pictures of one size in rows of `columns`, white between them; the one at index `framed`, if any, has a
/// black frame. Throws InputError where there is no picture or where they differ in size.
Picture picture_sheet(std::span<Picture const> pictures, int columns, int framed = -1);

/// Factor by which an error is multiplied before it is drawn: errors of 255 / 4 and more are white.
inline constexpr int error_gain = 4;

/// Sheet with a column for the reference and one for each of `shown`, in their order; below each of these the root mean
/// square of its three bytes' differences from the reference, times `error_gain`, in grey. Throws InputError likewise.
Picture beside_reference(Picture const& reference, std::span<Picture const> shown);

/// Writes that sheet as a PNG file, into a folder that is made where there is none.
void write_beside_reference(std::filesystem::path const& file, Picture const& reference,
                            std::span<Picture const> shown);

} // namespace framelet::bench
