// Several pictures as one, to be looked at side by side.
#pragma once

#include <filesystem>
#include <span>

#include "common/image.h"

namespace framelet::bench {

/// Pictures of one size in rows of `columns`, white between them; the one at index `framed`, if any, has a black frame.
/// InputError where there is none or where they differ in size.
Picture picture_sheet(std::span<Picture const> pictures, int columns, int framed = -1);

/// What an error is multiplied by before it is drawn: 255 / 4 and more is white.
inline constexpr int error_gain = 4;

/// A column for the reference and one for each of `shown`, in their order; below each of these the root mean square of
/// its three bytes' differences from the reference, times `error_gain`, in grey. InputError likewise.
Picture beside_reference(Picture const& reference, std::span<Picture const> shown);

/// That as a PNG file, in a folder that is made where there is none.
void write_beside_reference(std::filesystem::path const& file, Picture const& reference,
                            std::span<Picture const> shown);

} // namespace framelet::bench
