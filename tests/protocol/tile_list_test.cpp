#include "protocol/messages/tile_list.h"

#include <random>

#include <gtest/gtest.h>

#include "common/error.h"

namespace framelet {
namespace {

Bytes bytes_of(std::initializer_list<int> values) {
    Bytes bytes;
    for (int const value : values) {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

TEST(TileList, GoldenBytes) {
    // The second tile follows the first, the third skips one, the fourth is coarser and lies before them.
    std::vector<Tile> const tiles{make_tile(7, 0, 0), make_tile(7, 1, 0), make_tile(7, 1, 1), {(1u << 12) + 0}};
    Bytes const bytes = bytes_of({1, 7, 0, 4, 7, 6});
    EXPECT_EQ(write_tiles(tiles), bytes);
    EXPECT_EQ(read_tiles(bytes), tiles);
    EXPECT_TRUE(read_tiles({}).empty());
}

TEST(TileList, NeighboursTakeAByteEach) {
    std::vector<Tile> tiles;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        tiles.push_back({(1u << 14) + 7 * i});
    }
    EXPECT_EQ(write_tiles(tiles).size(), tiles.size() + 1);
}

TEST(TileList, AnyTilesComeBack) {
    std::mt19937 random(1);
    for (int list = 0; list < 20000; ++list) {
        std::vector<Tile> tiles;
        for (auto count = random() % 20; count > 0; --count) {
            auto const depth = static_cast<int>(random() % 16);
            std::uint32_t const there = 1u << 2 * depth;
            auto const index = static_cast<std::uint32_t>(random() % 4 == 0 ? there - 1 : random() % there);
            tiles.push_back({there + index});
        }
        EXPECT_EQ(read_tiles(write_tiles(tiles)), tiles);
    }
}

TEST(TileList, WhatIsNoListIsRefused) {
    for (Bytes const& bad : {
             bytes_of({1}), // the depth is missing
             bytes_of({0x80}), // so is the rest of a number
             bytes_of({0x80, 0x80, 0x80, 0x80, 0x80, 1}), // more than five digits
             bytes_of({1, 16}), // too deep
             bytes_of({1, 255}), bytes_of({0, 0}), // behind the root there is nothing
             bytes_of({4}), bytes_of({6}), // before the first tile
             bytes_of({0x81, 0x80, 0x04, 7}), // the 16384th of depth 7
         }) {
        EXPECT_THROW(read_tiles(bad), ProtocolError);
    }
    std::vector<Tile> tiles;
    for (std::uint32_t i = 0; i <= max_batch_framelets; ++i) {
        tiles.push_back({(1u << 20) + i});
    }
    EXPECT_THROW(read_tiles(write_tiles(tiles)), ProtocolError);
    tiles.pop_back();
    EXPECT_EQ(read_tiles(write_tiles(tiles)), tiles);
}

} // namespace
} // namespace framelet
