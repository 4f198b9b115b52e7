// Checks the palette of a TGA file, of which OpenImageIO 2.4 reads whatever entry a pixel names, be there one or not.
// In: the bytes of a TGA file. Out: what is wrong with it.
#pragma once

#include <cstddef>
#include <span>

namespace framelet {

/// Says in a few words why the colours of the file's pixels cannot be read; null where they can, as without a palette.
/// A file that ends too early is none of its concern.
char const* tga_palette_problem(std::span<std::byte const> tga);

} // namespace framelet
