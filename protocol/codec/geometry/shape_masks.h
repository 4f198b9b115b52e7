// Which sample lies on which layer: where that is otherwise than for the sample above; nothing where there is no
// choice. In: shapes of a group. Out: bytes, and back. PROTOCOL.md has the layout.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet_shape.h"
#include "protocol/codec/entropy/byte_cursor.h"

namespace framelet {

/// A shape's first byte: the number of layers, and 4 where something is loose. Never 0.
inline constexpr std::uint8_t largest_shape_head = 7;
inline std::uint8_t shape_head(FrameletShape const& shape) {
    return static_cast<std::uint8_t>(shape.layer_count + (shape.loose_samples.empty() ? 0 : 4));
}
constexpr std::uint8_t layers_of_head(std::uint8_t head) {
    return head & 3u;
}
constexpr bool head_has_loose(std::uint8_t head) {
    return head >= 4;
}

/// Most bytes of a framelet.
inline constexpr std::size_t most_mask_bytes = std::size_t{2} * framelet_samples;

/// Appends the masks of all shapes. Every sample must be on one of its layers or loose, and so many loose as there are
/// loose samples.
void encode_masks(std::span<FrameletShape const> shapes, std::vector<std::uint8_t>& out);

/// Sets `layer_of`, and `loose_samples` to so many as that has. ProtocolError where a head asks for others.
void decode_masks(ByteCursor& bytes, std::span<std::uint8_t const> heads, std::span<FrameletShape> shapes);

} // namespace framelet
