#include "server/stream/flow/lossy_tiles.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

ImagePlane const plane({40, 24}); // 64x64 pixels, one sample a pixel at depth 2

std::vector<Tile> listed(LossyTiles const& lossy) {
    std::vector<Tile> tiles;
    lossy.list(100000, tiles);
    return tiles;
}

TEST(LossyTiles, WhatCameLastCounts) {
    LossyTiles lossy;
    EXPECT_TRUE(lossy.empty());
    Tile const tile = make_tile(plane.pixel_depth(), 1, 0);
    lossy.sent(plane, tile, 8);
    EXPECT_TRUE(lossy.is_held(plane, tile));
    EXPECT_FALSE(lossy.is_held(plane, tile.parent()));
    EXPECT_FALSE(lossy.is_held(plane, tile.child(0))) << "what is coarser there does not make the finer one held";
    EXPECT_EQ(listed(lossy).size(), 16u);
    lossy.sent(plane, tile.child(1), lossless_qp);
    EXPECT_FALSE(lossy.is_held(plane, tile)) << "a part of it is better already";
    EXPECT_EQ(listed(lossy).size(), 12u);
    for (Tile const finest : listed(lossy)) {
        EXPECT_EQ(finest.depth(), plane.max_depth());
        lossy.sent(plane, finest, lossless_qp);
    }
    EXPECT_TRUE(lossy.empty());
}

TEST(LossyTiles, OnlyVisibleOnesCount) {
    LossyTiles lossy;
    lossy.sent(plane, Tile{1}, 3);
    EXPECT_EQ(listed(lossy).size(), 60u); // tiles of 4x4 pixels over 40x24
    EXPECT_TRUE(lossy.is_held(plane, Tile{1}));
    std::vector<Tile> few;
    lossy.list(7, few);
    EXPECT_EQ(few.size(), 7u);
    lossy.sent(ImagePlane({64, 64}), make_tile(2, 0, 0), lossless_qp);
    EXPECT_TRUE(lossy.empty()) << "another viewport: the viewer begins anew";
}

TEST(LossyTiles, UnchangedIsSentExactlyOnce) {
    LossyTiles lossy;
    std::vector<Tile> const tiles{make_tile(2, 0, 0), make_tile(2, 1, 0), make_tile(4, 8, 0)};
    std::vector<std::uint8_t> needed{1, 0, 1}, qps;
    choose_qps(plane, tiles, needed, 9, false, lossy, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_EQ(qps, (std::vector<std::uint8_t>{9, 9}));

    needed = {0, 0, 0};
    choose_qps(plane, tiles, needed, 9, false, lossy, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_TRUE(qps.empty()) << "all exact";
    EXPECT_TRUE(lossy.empty());

    needed = {0, 0, 0};
    choose_qps(plane, tiles, needed, 9, false, lossy, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(LossyTiles, FinestOfAStillPictureAreExact) {
    LossyTiles lossy;
    std::vector<Tile> const tiles{make_tile(4, 8, 0), make_tile(2, 0, 0), make_tile(4, 0, 0)};
    std::vector<std::uint8_t> needed{1, 1, 1}, qps;
    choose_qps(plane, tiles, needed, 9, true, lossy, qps);
    EXPECT_EQ(qps, (std::vector<std::uint8_t>{0, 9, 0}));
    EXPECT_EQ(listed(lossy).size(), 15u) << "the finer one of the batch shows";
}

} // namespace
} // namespace framelet
