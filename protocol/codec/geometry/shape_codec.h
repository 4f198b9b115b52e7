// Shapes of a group of framelets to bytes before compression, and back. PROTOCOL.md has the layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet_shape.h"
#include "protocol/codec/geometry/shape_masks.h"

namespace framelet {

/// Most bytes of a group of so many framelets, each with all layers, everything loose and all of it with velocities.
constexpr std::size_t most_shape_bytes(std::size_t framelets) {
    constexpr std::size_t head = 1, fading = 1, layer = 10, velocity = 6, loose = 3;
    return 1 + framelets * (head + fading + max_layers * (layer + velocity) + most_mask_bytes + 1 +
                            framelet_samples * (loose + velocity));
}

/// The parts of a group's bytes, in order; their statistics differ.
using ShapeParts = std::array<std::span<std::uint8_t const>, 3>;

/// Scratch that is reused.
class ShapeCodec {
public:
    /// `side_bits`: of each framelet, 0..31; its tile's side is 2^side_bits pixels, which a reader knows. Planes lose
    /// what `shape_quantisation` says, velocities and the inverse depths of what is loose at most half a unit of
    /// theirs. The parts are valid until the next call.
    ShapeParts encode(std::span<FrameletShape const> shapes, std::span<std::uint8_t const> side_bits);

    /// Fills so many shapes, which are empty before. Throws ProtocolError.
    static void decode(std::span<std::uint8_t const> bytes, std::span<std::uint8_t const> side_bits,
                       std::span<FrameletShape> shapes);

private:
    std::vector<std::uint8_t> layers_, masks_, loose_;
};

} // namespace framelet
