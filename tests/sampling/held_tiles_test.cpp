#include "server/sampling/held/held_tiles.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

ImagePlane const plane({40, 24}); // 64x64 pixels, one sample a pixel at depth 2
constexpr bool single = false, means = true;

std::vector<Tile> lossy_of(HeldTiles const& held) {
    std::vector<Tile> tiles;
    held.list_lossy(100000, tiles);
    return tiles;
}

TEST(HeldTiles, WhatCameLastShows) {
    HeldTiles held(plane);
    Tile const tile = make_tile(plane.pixel_depth(), 1, 0);
    EXPECT_FALSE(held.shows(tile, 7, single));
    held.put(tile, 7, single);
    EXPECT_TRUE(held.shows(tile, 7, single));
    EXPECT_FALSE(held.shows(tile, 8, single));
    EXPECT_FALSE(held.shows(tile, 7, means));
    EXPECT_FALSE(held.shows(tile.child(0), 7, single)) << "what is coarser there does not make the finer one held";
    held.put(tile.child(1), 9, single);
    EXPECT_FALSE(held.shows(tile, 7, single)) << "a part of it shows something else";
    EXPECT_TRUE(held.shows(tile.child(1), 9, single));
    held.put(tile, 7, single);
    held.forget_contents();
    EXPECT_FALSE(held.shows(tile, 7, single)) << "the viewer has moved it away";
    held.put(tile, 0, single);
    EXPECT_FALSE(held.shows(tile, 7, single)) << "and will move this";
}

TEST(HeldTiles, MeansStandBesideTheSingleRaysTheyFollow) {
    HeldTiles held(plane);
    Tile const tile = make_tile(plane.max_depth(), 3, 2);
    held.put(tile, 5, means);
    EXPECT_TRUE(held.shows(tile, 5, means));
    EXPECT_FALSE(held.shows(tile, 5, single));
    held.put(tile, 6, single);
    EXPECT_FALSE(held.shows_means(tile));
    held.put(tile, 5, means);
    EXPECT_TRUE(held.shows(tile, 5, means) && held.shows(tile, 6, single) && held.shows_means(tile));
    held.put(tile, 4, single);
    EXPECT_FALSE(held.shows(tile, 5, means)) << "something has changed";
}

TEST(HeldTiles, OnlyPlacesInTheViewportCount) {
    HeldTiles held(plane);
    held.put(Tile{1}, 3, single);
    held.set_lossy(Tile{1}, true);
    EXPECT_TRUE(held.shows(Tile{1}, 3, single));
    EXPECT_TRUE(held.is_lossy(Tile{1}));
    EXPECT_EQ(lossy_of(held).size(), 60u); // tiles of 4x4 pixels over 40x24
    for (Tile const tile : lossy_of(held)) {
        EXPECT_TRUE(plane.is_visible(tile));
        EXPECT_EQ(tile.depth(), plane.max_depth());
    }
    std::vector<Tile> few;
    held.list_lossy(7, few);
    EXPECT_EQ(few.size(), 7u);
}

TEST(HeldTiles, WhatIsSentExactlyIsLossyNoLonger) {
    HeldTiles held(plane);
    Tile const tile = make_tile(plane.pixel_depth(), 1, 0);
    EXPECT_FALSE(held.any_lossy());
    held.put(tile, 1, single);
    held.set_lossy(tile, true);
    EXPECT_TRUE(held.is_lossy(tile));
    EXPECT_FALSE(held.is_lossy(tile.parent()));
    EXPECT_FALSE(held.is_lossy(tile.child(0)));
    EXPECT_EQ(lossy_of(held).size(), 16u);
    held.put(tile.child(1), 1, single);
    held.set_lossy(tile.child(1), false);
    EXPECT_FALSE(held.is_lossy(tile)) << "a part of it is better already";
    EXPECT_EQ(lossy_of(held).size(), 12u);
    for (Tile const finest : lossy_of(held)) {
        held.set_lossy(finest, false);
    }
    EXPECT_FALSE(held.any_lossy());
}

TEST(HeldTiles, ContentsDifferWhereAnyColourDoes) {
    DisplayFramelet framelet;
    framelet.red.fill(1);
    framelet.green.fill(2);
    framelet.blue.fill(3);
    std::uint64_t const content = content_of(framelet);
    EXPECT_NE(content, 0u);
    EXPECT_EQ(content_of(framelet), content);
    for (auto* const channel : {&framelet.red, &framelet.green, &framelet.blue}) {
        for (std::uint8_t& value : *channel) {
            value ^= 1;
            ASSERT_NE(content_of(framelet), content);
            value ^= 1;
        }
    }
}

} // namespace
} // namespace framelet
