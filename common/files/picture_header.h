// Tells what kind of picture a file is, and how large, from its bytes alone: readers take memory for the whole picture,
// some of them as they open it. In: a file's bytes. Out: its format and size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace framelet {

enum class PictureFormat : std::uint8_t { png, jpeg, webp, tga, bmp, pnm, hdr, exr };

/// The format that the bytes begin as; nothing where it is none of these. TGA files have no signature: what could be
/// one and nothing else is taken for one.
std::optional<PictureFormat> picture_format(std::span<std::byte const> bytes);

/// The name of a well-known format of pictures or textures that is none of these; null where it is none.
char const* foreign_format(std::span<std::byte const> bytes);

struct PictureSize {
    std::int64_t width = 0, height = 0; ///< pixels, >= 0
    bool operator==(PictureSize const&) const = default;
};

/// The size that the header of a JPEG, WebP, TGA or BMP file gives; nothing where it has none.
std::optional<PictureSize> header_size(PictureFormat format, std::span<std::byte const> bytes);

/// Bytes that are taken beside the picture while it is decoded: the coefficients of a JPEG whose parts come one after
/// the other. 0 for what is none of these formats.
std::uint64_t bytes_beside(std::span<std::byte const> bytes);

} // namespace framelet
