#include "server/sampling/model/luma_history.h"

#include <map>
#include <random>

#include <gtest/gtest.h>

#include "common/color.h"

namespace framelet {
namespace {

DisplayFramelet random_framelet(Tile tile, std::mt19937& random) {
    DisplayFramelet out;
    out.tile = tile;
    for (auto* const plane : {&out.red, &out.green, &out.blue}) {
        for (auto& byte : *plane) {
            byte = static_cast<std::uint8_t>(random());
        }
    }
    return out;
}

TEST(LumaHistory, CollisionsForgetAndNeverLie) {
    std::mt19937 random(1);
    for (std::size_t const entries : {std::size_t{1}, std::size_t{16}, std::size_t{1024}}) {
        LumaHistory history(entries);
        std::map<Tile, double> stored;
        std::size_t remembered = 0;
        for (int i = 0; i < 5000; ++i) {
            Tile const tile = make_tile(8, random() % 64, random() % 64);
            LumaHistory::Entry entry;
            entry.tile = tile;
            entry.time = i;
            entry.luma[17] = static_cast<std::uint16_t>(i);
            history.store(entry);
            stored[tile] = i;
            auto const* const found = history.find(tile);
            ASSERT_NE(found, nullptr) << "the newest is always there";
            Tile const other = make_tile(8, random() % 64, random() % 64);
            if (auto const* const known = history.find(other)) {
                ASSERT_EQ(known->tile, other);
                ASSERT_EQ(known->time, stored.at(other));
                ASSERT_EQ(known->luma[17], static_cast<std::uint16_t>(known->time));
            }
        }
        for (auto const& [tile, time] : stored) {
            remembered += history.find(tile) != nullptr ? 1 : 0;
        }
        EXPECT_LE(remembered, entries);
        EXPECT_GE(remembered, std::min(entries, stored.size()) / 2) << "tiles spread over the table";
        history.clear();
        for (auto const& [tile, time] : stored) {
            EXPECT_EQ(history.find(tile), nullptr);
        }
    }
}

/// All tiles of a picture of 1280x720 at one sample a pixel, and their parents: most are remembered.
TEST(LumaHistory, RemembersAPicture) {
    LumaHistory history;
    std::vector<Tile> tiles;
    for (std::uint32_t row = 0; row < 45; ++row) {
        for (std::uint32_t column = 0; column < 80; ++column) {
            tiles.push_back(make_tile(7, column, row));
        }
    }
    for (Tile const tile : tiles) {
        history.store({tile, 1, 0, {}});
    }
    std::size_t remembered = 0;
    for (Tile const tile : tiles) {
        remembered += history.find(tile) != nullptr ? 1 : 0;
    }
    EXPECT_GE(remembered, tiles.size() * 3 / 4);
}

/// Tiles of one sample a pixel and their descendants of 16: they do not drive each other out.
TEST(LumaHistory, ParentsAndDescendantsStayTogether) {
    LumaHistory history;
    std::size_t remembered = 0;
    for (int round = 0; round < 2; ++round) {
        for (std::uint32_t i = 0; i < 208; ++i) {
            Tile const tile = make_tile(4, i % 16, i / 16);
            remembered += history.find(tile) != nullptr ? 1 : 0;
            history.store({tile, 1.0 + round, 0, {}});
            for (std::uint32_t k = 0; k < 16; ++k) {
                history.store({{tile.code * 16 + k}, 1.0 + round, 0, {}});
            }
        }
    }
    EXPECT_GE(remembered, 200u);
}

LumaHistory::Entry make_entry(DisplayFramelet const& framelet, double time) {
    LumaHistory::Entry entry;
    fill_entry(entry, framelet, time, time);
    return entry;
}

TEST(LumaHistory, EveryByteCountsInTheContent) {
    std::mt19937 random(2);
    DisplayFramelet framelet = random_framelet(make_tile(3, 1, 2), random);
    LumaHistory::Entry const entry = make_entry(framelet, 5);
    EXPECT_EQ(entry.tile, framelet.tile);
    EXPECT_EQ(entry.time, 5);
    EXPECT_EQ(make_entry(framelet, 6).content, entry.content) << "time is no content";
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        EXPECT_FLOAT_EQ(static_cast<float>(entry.luma[i]) / LumaHistory::luma_steps,
                        display_luma(framelet.red[i], framelet.green[i], framelet.blue[i]));
        for (auto* const plane : {&framelet.red, &framelet.green, &framelet.blue}) {
            std::uint8_t const byte = (*plane)[i];
            (*plane)[i] ^= static_cast<std::uint8_t>(1u << (random() % 8));
            EXPECT_NE(make_entry(framelet, 5).content, entry.content) << i;
            (*plane)[i] = byte;
        }
    }
    // Other colours may have equal luma.
    DisplayFramelet other = framelet;
    other.red[9] = 100;
    other.blue[9] = 50;
    DisplayFramelet swapped = other;
    std::swap(swapped.red[9], swapped.blue[9]);
    EXPECT_EQ(make_entry(other, 0).luma, make_entry(swapped, 0).luma);
    EXPECT_NE(make_entry(other, 0).content, make_entry(swapped, 0).content);
}

} // namespace
} // namespace framelet
