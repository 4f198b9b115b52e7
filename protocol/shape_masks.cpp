#include "protocol/shape_masks.h"

#include <algorithm>
#include <array>

#include "common/error.h"
#include "common/morton.h"

namespace framelet {
namespace {

constexpr std::size_t plane_bytes = framelet_samples / 8;

/// What a sample may be: one of the layers, or loose, which is the last kind. The mask has bits for the kind's number.
constexpr int bits_of(std::uint8_t head) {
    int const kinds = layers_of_head(head) + (head_has_loose(head) ? 1 : 0);
    return kinds <= 1 ? 0 : kinds == 2 ? 1 : 2;
}

/// Bit `bit` of the kinds in 16 rows, each as its difference (exclusive or) from the row above.
void put_plane(FrameletShape const& shape, int bit, std::vector<std::uint8_t>& out) {
    std::uint8_t const loose = shape.layer_count;
    std::array<std::uint8_t, framelet_samples> bits;
    for (std::size_t i = 0; i < bits.size(); ++i) {
        bits[i] = std::min(shape.layer_of[i], loose) >> bit & 1;
    }
    std::array<std::uint16_t, framelet_side> rows{};
    for (std::uint32_t i = 0; i < framelet_samples; i += 4) { // two of a row, two of the next
        std::uint32_t const x = morton_x(i), y = morton_y(i);
        rows[y] = static_cast<std::uint16_t>(rows[y] | (bits[i] | bits[i + 1] << 1) << x);
        rows[y + 1] = static_cast<std::uint16_t>(rows[y + 1] | (bits[i + 2] | bits[i + 3] << 1) << x);
    }
    unsigned above = 0;
    for (std::uint16_t const row : rows) {
        out.push_back(static_cast<std::uint8_t>(row ^ above));
        out.push_back(static_cast<std::uint8_t>((row ^ above) >> 8));
        above = row;
    }
}

/// The reverse: adds the bit to `layer_of`.
void take_plane(std::span<std::uint8_t const> bytes, int bit, FrameletShape& shape) {
    std::array<std::uint16_t, framelet_side> rows{};
    unsigned above = 0;
    for (std::size_t y = 0; y < rows.size(); ++y) {
        above ^= static_cast<unsigned>(bytes[2 * y] | bytes[2 * y + 1] << 8);
        rows[y] = static_cast<std::uint16_t>(above);
    }
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        shape.layer_of[i] |= static_cast<std::uint8_t>((rows[morton_y(i)] >> morton_x(i) & 1u) << bit);
    }
}

/// From kinds to layers, with place for what is loose.
void resolve_kinds(std::uint8_t head, FrameletShape& shape) {
    std::size_t loose = 0;
    for (std::uint8_t& kind : shape.layer_of) {
        if (kind >= shape.layer_count) {
            if (kind > shape.layer_count || !head_has_loose(head)) {
                throw ProtocolError("a shape has a sample on a layer that it does not have");
            }
            kind = FrameletShape::loose;
            ++loose;
        }
    }
    if (head_has_loose(head) && loose == 0) {
        throw ProtocolError("a shape has none of the loose samples that it announces");
    }
    shape.loose_samples.resize(loose);
}

} // namespace

void encode_masks(std::span<FrameletShape const> shapes, std::vector<std::uint8_t>& out) {
    for (FrameletShape const& shape : shapes) {
        std::size_t loose = 0, none = 0;
        for (std::uint8_t const layer : shape.layer_of) { // without an early end: many at a time
            loose += layer == FrameletShape::loose ? 1 : 0;
            none += layer >= shape.layer_count ? 1 : 0;
        }
        FRAMELET_CHECK(loose == none && loose == shape.loose_samples.size());
    }
    for (int bit = 0; bit < 2; ++bit) {
        for (FrameletShape const& shape : shapes) {
            if (bit < bits_of(shape_head(shape))) {
                put_plane(shape, bit, out);
            }
        }
    }
}

void decode_masks(ByteCursor& bytes, std::span<std::uint8_t const> heads, std::span<FrameletShape> shapes) {
    for (FrameletShape& shape : shapes) {
        shape.layer_of.fill(0);
    }
    for (int bit = 0; bit < 2; ++bit) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            if (bit < bits_of(heads[i])) {
                take_plane(bytes.take(plane_bytes), bit, shapes[i]);
            }
        }
    }
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        resolve_kinds(heads[i], shapes[i]);
    }
}

} // namespace framelet
