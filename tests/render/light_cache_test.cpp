#include "server/render/cache/light_cache.h"

#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr float scene_size = 8; // the coarsest cells have 1 m
constexpr std::size_t all_asked = 1u << 20;

GatheredLight gathered(float shade, float paths = 64, float noise = 0) {
    GatheredLight g;
    g.paths = paths;
    g.sum.all = Vec3(shade * paths);
    g.squares = (shade * shade + noise * noise) * paths;
    g.nearness = 0.2f * paths; // what lights it is 5 m away
    return g;
}

LightPlace on_floor(float x, float z, float y = 0) {
    return {0, {x, y, z}, {0, 1, 0}};
}

/// The shade that is shown there; -1: nothing is known.
float shade(LightCache& cache, LightPlace const& place, float cell_size) {
    IncomingLight light;
    return cache.look_up(place, cell_size, light) ? light.all.g : -1;
}

/// The record of the cell of this size that a place is in, of the surface that is nearest; null where there is none.
LightRecord const* nearest(LightCache const& cache, LightPlace const& place, float cell_size) {
    LightCells const cells(scene_size);
    CellKey const key = cells.key_of(place, static_cast<int>(cells.level_of(cell_size) + 0.5f));
    constexpr std::uint32_t sheets = 3u << 8;
    LightRecord const* found = nullptr;
    for (LightRecord const& record : cache.records()) {
        auto const apart = [&](LightRecord const& r) {
            return std::abs(glm::dot(place.normal, r.place.position - place.position));
        };
        if (record.key.cell == key.cell && (record.key.kind & ~sheets) == key.kind &&
            (found == nullptr || apart(record) < apart(*found))) {
            found = &record;
        }
    }
    return found;
}

/// Looks up a place so that it has a record, and says how bright it is there.
void teach(LightCache& cache, LightPlace const& place, float cell_size, GatheredLight const& light) {
    shade(cache, place, cell_size);
    cache.admit(all_asked);
    LightRecord const* const record = nearest(cache, place, cell_size);
    ASSERT_NE(record, nullptr);
    cache.add(static_cast<std::uint32_t>(record - cache.records().data()), light, 1);
}

/// Teaches 8x8 cells of a floor, in their middles, how bright it is there.
template <class Truth>
void teach_floor(LightCache& cache, float cell, Truth const& truth) {
    for (int x = 0; x < 8; ++x) {
        for (int z = 0; z < 8; ++z) {
            LightPlace const place =
                on_floor((static_cast<float>(x) + 0.123f) * cell, (static_cast<float>(z) + 0.123f) * cell);
            teach(cache, place, cell, gathered(truth(place.position), 1e6f));
        }
    }
}

TEST(LightCache, WhatIsNewShowsWhatIsAroundIt) {
    LightCache cache(scene_size);
    constexpr float cell = 1.0f / 16;
    EXPECT_EQ(shade(cache, on_floor(0.1f, 0.1f), cell), -1) << "nothing is known yet";
    teach(cache, on_floor(0.1f, 0.1f), cell, gathered(3));
    EXPECT_FLOAT_EQ(shade(cache, on_floor(0.1f, 0.1f), cell), 3);
    EXPECT_FLOAT_EQ(shade(cache, on_floor(0.3f, 0.2f), cell), 3) << "as a coarser cell is";
    cache.admit(all_asked);
    EXPECT_FLOAT_EQ(shade(cache, on_floor(0.3f, 0.2f), cell), 3) << "with a record of its own";
    EXPECT_FLOAT_EQ(shade(cache, {0, {0.1f, 0, 0.1f}, {0, -1, 0}}, cell), 3) << "the other side: as everywhere";
    EXPECT_FLOAT_EQ(shade(cache, on_floor(7, 7), cell), 3) << "far off";
}

TEST(LightCache, OfWhatIsAskedForSomeIsMadeOfAllPartsAlikeAndTheRestShowsCoarserLight) {
    LightCache cache(scene_size);
    constexpr float cell = 1.0f / 16;
    constexpr int side = 32;
    constexpr std::size_t most = 64;
    auto const look = [&] { // at the middles of 1024 cells, 2 m x 2 m, from left to right
        std::array<int, 2> made{};
        for (int i = 0; i < side * side; ++i) {
            float const x = static_cast<float>(i / side), z = static_cast<float>(i % side);
            LightPlace const place = on_floor((x + 0.123f) * cell, (z + 0.123f) * cell);
            shade(cache, place, cell);
            made[static_cast<std::size_t>(2 * (i / side) / side)] += nearest(cache, place, cell) != nullptr ? 1 : 0;
        }
        return made;
    };
    look();
    EXPECT_EQ(cache.admit(most), LightCache::Admitted::some);
    std::array<int, 2> const made = look();
    EXPECT_NEAR(made[0], most / 2, most / 8);
    EXPECT_NEAR(made[1], most / 2, most / 8);
    teach(cache, on_floor(0.01f, 0.01f), cell, gathered(3));
    for (std::size_t i = 0; i < side * side / most; ++i) {
        cache.admit(most);
        look();
    }
    std::array<int, 2> const in_the_end = look();
    EXPECT_EQ(in_the_end[0] + in_the_end[1], side * side);
    EXPECT_EQ(cache.admit(0), LightCache::Admitted::nothing);
}

TEST(LightCache, SmoothWhileItIsNoiseAndItsOwnWhenItIsKnown) {
    LightCache cache(scene_size);
    constexpr float cell = 1.0f / 16;
    for (int i = 0; i < 8; ++i) {
        teach(cache, on_floor(0.01f + 0.0625f * static_cast<float>(i % 4), 0.01f), cell, gathered(1, 64, 2));
    }
    LightPlace const other = on_floor(0.14f, 0.14f);
    teach(cache, other, cell, gathered(1.5f, 16, 2));
    float const early = nearest(cache, other, cell)->shown.all.g;
    EXPECT_LT(early, 1.15f) << "half a brightness more is within the noise of 16 paths";
    for (int i = 0; i < 4000; ++i) {
        teach(cache, other, cell, gathered(1.5f, 64, 2));
    }
    EXPECT_NEAR(nearest(cache, other, cell)->shown.all.g, 1.5f, 0.01f);
}

TEST(LightCache, WhatChangesEvenlyIsShownSo) {
    LightCache cache(scene_size);
    constexpr float cell = 1.0f / 16;
    auto const truth = [](Vec3 const& at) { return 1 + 0.5f * at.x + 0.2f * at.z; };
    std::vector<LightPlace> places;
    for (int x = 0; x < 24; ++x) {
        for (int z = 0; z < 24; ++z) { // the middles of its cells
            places.push_back(
                on_floor((static_cast<float>(x) + 0.123f) * cell, (static_cast<float>(z) + 0.123f) * cell));
        }
    }
    for (LightPlace const& place : places) {
        shade(cache, place, cell);
    }
    cache.admit(all_asked);
    for (LightPlace const& place : places) {
        teach(cache, place, cell, gathered(truth(place.position), 1e6f));
    }
    for (float x = 0.2f; x < 1.2f; x += 0.037f) {
        LightPlace const place = on_floor(x, 0.3f + 0.5f * x);
        EXPECT_NEAR(shade(cache, place, cell), truth(place.position), 2e-3f) << x;
    }
}

TEST(LightCache, WhatIsNewShowsCoarserLightWithoutSteps) {
    LightCache cache(scene_size);
    constexpr float coarse = 0.25f, fine = coarse / 4;
    auto const truth = [](Vec3 const& at) { return 1 + 0.5f * at.x; };
    teach_floor(cache, coarse, truth);
    auto const line = [](float x) { return on_floor(x, 0.7f); };
    for (float x = 0.3f; x < 1.5f; x += 0.02f) {
        shade(cache, line(x), fine);
    }
    cache.admit(all_asked);
    for (float x = 0.4f; x < 1.4f; x += 0.02f) {
        EXPECT_NE(nearest(cache, line(x), fine), nullptr);
        EXPECT_NEAR(shade(cache, line(x), fine), truth(line(x).position), 0.25f * fine)
            << x << ": a record stands where its cell was first looked up, at most half a cell off its middle";
    }
}

TEST(LightCache, WhatHasNoRecordsShowsCoarserLightWithoutSteps) {
    LightCache cache(scene_size);
    constexpr float coarse = 0.25f, fine = coarse / 4;
    auto const truth = [](Vec3 const& at) { return 1 + 0.5f * at.x; };
    teach_floor(cache, coarse, truth);
    for (float x = 0.4f; x < 1.4f; x += 0.02f) {
        EXPECT_NEAR(shade(cache, on_floor(x, 0.7f), fine), truth({x, 0, 0.7f}), 2e-3f) << x;
    }
}

TEST(LightCache, BesideWhatWasMadeAndLearntFirstThereIsNoStep) {
    LightCache cache(scene_size);
    constexpr float coarse = 0.25f, fine = coarse / 4;
    teach_floor(cache, coarse, [](Vec3 const&) { return 1.0f; });
    auto const look = [&] {
        std::vector<float> shades;
        for (float x = 0.3f; x < 1.5f; x += 0.004f) {
            for (float z = 0.5f; z < 0.9f; z += fine) { // its neighbours are looked at, too
                shade(cache, on_floor(x, z), fine);
            }
            shades.push_back(shade(cache, on_floor(x, 0.7f), fine));
        }
        return shades;
    };
    LightPlace const first = on_floor(0.9f, 0.7f);
    teach(cache, first, fine, gathered(3, 1e6f));
    look();
    cache.admit(0); // the others have to wait
    float before = 1;
    for (float const shade : look()) {
        EXPECT_NEAR(shade, before, 2.0f * 0.004f / fine * 1.2f) << "from middle to middle it changes evenly";
        before = shade;
    }
    EXPECT_NEAR(shade(cache, first, fine), 3, 1.0f);
}

/// The least and the most that is shown amid 16x16 cells of a floor, of which each has gathered `light(NUMBER)`.
template <class Light>
std::array<float, 2> least_and_most(Light light) {
    LightCache cache(scene_size);
    constexpr float cell = 1.0f / 16;
    std::vector<LightPlace> places;
    for (int i = 0; i < 256; ++i) {
        places.push_back(
            on_floor((static_cast<float>(i % 16) + 0.123f) * cell, (static_cast<float>(i / 16) + 0.123f) * cell));
        teach(cache, places.back(), cell, light(i));
    }
    std::vector<std::uint32_t> wanted;
    cache.list_wanted(1, LightCache::Use::recent, wanted);
    for (int i = 0; i < 20; ++i) {
        cache.renew(cache.records().size());
    }
    std::array<float, 2> out{INFINITY, 0};
    for (int i = 0; i < 256; ++i) {
        if (std::abs(i % 16 - 8) < 4 && std::abs(i / 16 - 8) < 4) {
            float const shown = nearest(cache, places[static_cast<std::size_t>(i)], cell)->shown.all.g;
            out = {std::min(out[0], shown), std::max(out[1], shown)};
        }
    }
    return out;
}

TEST(LightCache, CellsAreAsSmoothAsTheirPathsAreFew) {
    auto const apart = [](float paths) {
        auto const [least, most] = least_and_most([&](int i) { return gathered(i % 2 == 0 ? 0.9f : 1.1f, paths, 1); });
        return most - least;
    };
    EXPECT_LT(apart(16), 0.05f);
    EXPECT_GT(apart(10000), 0.18f);
}

TEST(LightCache, WhatRareBrightPathsBringIsSharedWithAllAround) {
    auto const [least, most] = least_and_most([](int i) {
        GatheredLight light = gathered(1, 16, 1);
        light.excess = i % 16 == 7 ? 128.0f : 0.0f; // 16 of 4096 paths have brought half as much as all others
        return light;
    });
    EXPECT_NEAR(least, 1.5f, 0.4f) << "and not 1";
    EXPECT_NEAR(most, 1.5f, 0.4f) << "and not 9";
}

TEST(LightCache, SheetsOfOneCellHaveRecordsOfTheirOwn) {
    LightCache cache(scene_size);
    constexpr float cell = 0.25f;
    for (float const y : {0.0f, 0.1f}) {
        shade(cache, on_floor(0.1f, 0.1f, y), cell);
        cache.admit(all_asked);
    }
    for (int i = 0; i < 200; ++i) {
        teach(cache, on_floor(0.1f, 0.1f, 0), cell, gathered(1, 1e5f));
        teach(cache, on_floor(0.1f, 0.1f, 0.1f), cell, gathered(5, 1e5f));
    }
    EXPECT_NEAR(shade(cache, on_floor(0.1f, 0.1f, 0), cell), 1, 0.05f);
    EXPECT_NEAR(shade(cache, on_floor(0.1f, 0.1f, 0.1f), cell), 5, 0.05f);
}

TEST(LightCache, GoodRecordsAskForNothing) {
    LightCache cache(scene_size);
    std::vector<std::uint32_t> wanted;
    teach(cache, on_floor(0, 0), 0.25f, gathered(1, 16, 1));
    cache.list_wanted(100, LightCache::Use::recent, wanted);
    EXPECT_EQ(wanted.size(), 1u);
    teach(cache, on_floor(0, 0), 0.25f, gathered(1, 3000, 1));
    cache.list_wanted(100, LightCache::Use::recent, wanted);
    EXPECT_TRUE(wanted.empty());
}

TEST(LightCache, WhatNobodyLooksAtAnyMoreIsLearntWhereThereIsTime) {
    LightCache cache(scene_size);
    std::vector<std::uint32_t> wanted;
    teach(cache, on_floor(0, 0), 0.25f, gathered(1, 16, 1));
    cache.note_unwatched();
    cache.list_wanted(100, LightCache::Use::recent, wanted);
    EXPECT_TRUE(wanted.empty());
    cache.list_wanted(100, LightCache::Use::any, wanted);
    EXPECT_EQ(wanted.size(), 1u);
    shade(cache, on_floor(0, 0), 0.25f);
    cache.list_wanted(100, LightCache::Use::recent, wanted);
    EXPECT_EQ(wanted.size(), 1u) << "somebody does again";
}

TEST(LightCache, PathsEndWhereEnoughIsKnownInTheirPose) {
    LightCache cache(scene_size);
    LightPlace const place = on_floor(0.1f, 0.1f);
    IncomingLight light;
    EXPECT_FALSE(cache.find_known(place, 0.25f, 1, light));
    EXPECT_EQ(cache.admit(all_asked), LightCache::Admitted::nothing) << "it has asked for nothing";
    teach(cache, place, 0.25f, gathered(3, 16));
    EXPECT_FALSE(cache.find_known(place, 0.25f, 1, light)) << "of too few paths";
    teach(cache, place, 0.25f, gathered(3, 64));
    ASSERT_TRUE(cache.find_known(place, 0.25f, 1, light));
    EXPECT_FLOAT_EQ(light.all.g, 3);
    ASSERT_TRUE(cache.find_known(place, 1.0f / 16, 1, light)) << "of the coarser cell around";
    EXPECT_FLOAT_EQ(light.all.g, 3);
    EXPECT_FALSE(cache.find_known(place, 1.0f / 64, 1, light)) << "which is too coarse for this";
    EXPECT_FALSE(cache.find_known({0, place.position, {0, -1, 0}}, 0.25f, 1, light)) << "of the other side";
    cache.note_pose();
    EXPECT_FALSE(cache.find_known(place, 0.25f, 2, light)) << "it was not checked since";
    EXPECT_TRUE(cache.find_known(place, 0.25f, 1, light)) << "whoever was not checked either knows no better";
    auto const record = static_cast<std::uint32_t>(nearest(cache, place, 0.25f) - cache.records().data());
    cache.check(record, 1);
    EXPECT_TRUE(cache.find_known(place, 0.25f, 2, light));
}

TEST(LightCache, WhatWasNotLookedUpForLongestLeaves) {
    constexpr std::size_t bytes = std::size_t{200} << 10;
    LightCache cache(scene_size, bytes);
    constexpr float cell = 1.0f / 64;
    LightPlace const seen = on_floor(-1, -1);
    teach(cache, seen, cell, gathered(2));
    for (int i = 0; i < 400; ++i) {
        for (int k = 0; k < 30; ++k) {
            shade(cache, on_floor(static_cast<float>(i) * cell, static_cast<float>(k) * cell), cell);
        }
        shade(cache, seen, cell);
        cache.admit(all_asked);
        EXPECT_LE(cache.records().size_bytes(), bytes);
    }
    ASSERT_NE(nearest(cache, seen, cell), nullptr);
    EXPECT_EQ(nearest(cache, seen, cell)->own, 64);
    EXPECT_FLOAT_EQ(shade(cache, seen, cell), 2);
    EXPECT_EQ(nearest(cache, on_floor(0, 0), cell), nullptr);
}

} // namespace
} // namespace framelet
