#include "protocol/messages/tile_list.h"

#include <algorithm>

#include "common/error.h"

namespace framelet {
namespace {

constexpr int most_depth = 15;
constexpr int digit_bits = 7;
constexpr std::uint64_t more = 1u << digit_bits;

/// The place where the next tile is expected: behind the last one.
class Cursor {
public:
    int depth() const { return depth_; }
    /// Index of the expected tile, if it is of that depth.
    std::int64_t index(int depth) const { return end_ >> 2 * (most_depth - depth); }
    void pass(Tile tile) {
        depth_ = tile.depth();
        end_ = (std::int64_t{tile.index()} + 1) << 2 * (most_depth - depth_);
    }

private:
    int depth_ = 0;
    std::int64_t end_ = 0; ///< index of the expected tile among those of the greatest depth
};

/// Writes a number as seven bits a byte, the lowest first; bit 7 is set in all bytes but the last.
void write_number(std::uint64_t number, Bytes& bytes) {
    for (; number >= more; number >>= digit_bits) {
        bytes.push_back(static_cast<std::byte>(number | more));
    }
    bytes.push_back(static_cast<std::byte>(number));
}

std::uint64_t read_number(ByteView& bytes) {
    constexpr int most_digits = 5;
    std::uint64_t number = 0;
    for (int digit = 0; digit < most_digits && !bytes.empty(); ++digit) {
        auto const byte = static_cast<std::uint64_t>(bytes.front());
        bytes = bytes.subspan(1);
        number |= byte % more << digit_bits * digit;
        if (byte < more) {
            return number;
        }
    }
    throw ProtocolError("a batch's list of tiles is cut off");
}

} // namespace

Bytes write_tiles(std::span<Tile const> tiles) {
    Bytes bytes;
    bytes.reserve(2 * tiles.size());
    Cursor cursor;
    for (Tile const tile : tiles) {
        std::int64_t const distance = std::int64_t{tile.index()} - cursor.index(tile.depth());
        auto const size = static_cast<std::uint64_t>(distance < 0 ? -distance : distance);
        bool const is_other_depth = tile.depth() != cursor.depth();
        write_number(size << 2 | (distance < 0 ? 2u : 0u) | (is_other_depth ? 1u : 0u), bytes);
        if (is_other_depth) {
            bytes.push_back(static_cast<std::byte>(tile.depth()));
        }
        cursor.pass(tile);
    }
    return bytes;
}

std::vector<Tile> read_tiles(ByteView bytes) {
    std::vector<Tile> tiles;
    tiles.reserve(std::min(bytes.size(), max_batch_framelets)); // more is refused
    Cursor cursor;
    while (!bytes.empty()) {
        std::uint64_t const number = read_number(bytes);
        int depth = cursor.depth();
        if ((number & 1) != 0) {
            if (bytes.empty()) {
                throw ProtocolError("a batch's list of tiles is cut off");
            }
            depth = static_cast<int>(bytes.front());
            bytes = bytes.subspan(1);
        }
        auto const size = static_cast<std::int64_t>(number >> 2);
        if (depth > most_depth) {
            throw ProtocolError("a batch has a tile of a depth beyond 15");
        }
        std::int64_t const index = cursor.index(depth) + ((number & 2) != 0 ? -size : size);
        std::int64_t const tiles_there = std::int64_t{1} << 2 * depth;
        if (index < 0 || index >= tiles_there) {
            throw ProtocolError("a batch has a tile outside of its plane");
        }
        if (tiles.size() == max_batch_framelets) {
            throw ProtocolError("a batch has more than 32768 framelets");
        }
        tiles.push_back({static_cast<std::uint32_t>(tiles_there + index)});
        cursor.pass(tiles.back());
    }
    return tiles;
}

} // namespace framelet
