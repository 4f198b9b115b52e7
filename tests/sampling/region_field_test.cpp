#include "server/sampling/field/region_field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/sampling/synthetic_refresh.h"

namespace framelet {
namespace {

/// Learns patches of a picture, one after the other.
class Learner {
public:
    explicit Learner(Viewport viewport) : field(ImagePlane(viewport)) {}

    /// Learns a patch; returns whether it is to be sent.
    bool learn(Patch const& patch, double now, std::function<float(float, float)> const& shade) {
        std::vector<Tile> tiles;
        append_tiles(field.plane(), patch, tiles);
        std::vector<DisplayFramelet> display(tiles.size());
        std::vector<Framelet> rendered(tiles.size());
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            display[t].tile = rendered[t].tile = tiles[t];
            PixelRect const rect = field.plane().tile_rect(tiles[t]);
            float const spacing = field.plane().sample_spacing(tiles[t]);
            for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                float const x = static_cast<float>(rect.left) + (static_cast<float>(morton_x(i)) + 0.5f) * spacing;
                float const y = static_cast<float>(rect.top) + (static_cast<float>(morton_y(i)) + 0.5f) * spacing;
                display[t].red[i] = static_cast<std::uint8_t>(std::lround(255 * shade(x, y)));
            }
            display[t].green = display[t].blue = display[t].red;
            rendered[t].depth.fill(4);
            rendered[t].body = bodies;
        }
        std::vector<LumaHistory::Entry> entries(tiles.size());
        RegionField::Range const range = field.range_of(patch.node);
        std::vector<RegionFindings> regions(range.last - range.first);
        double const same_since =
            examine_patch(field, patch, display, rendered, {now, now}, moment, history, entries, regions);
        for (LumaHistory::Entry const& entry : entries) {
            history.store(entry);
        }
        return learn_patch(field, patch, regions, same_since, still_since, now, skips);
    }
    Patch patch(int level, std::uint32_t index = 0) const {
        return {{(1u << (2 * field.depth())) + index}, field.depth_of(level)};
    }

    RegionField field;
    LumaHistory history;
    RenderedMoment moment; ///< the viewer moves nothing
    double still_since = 0;
    bool skips = true;
    std::vector<BodyNumber> bodies; ///< of the samples; empty: none
};

float still(float x, float y) {
    return smooth_noise(x / 5, y / 5);
}

TEST(RegionField, RegionsCoverTheViewport) {
    for (Viewport const viewport : {Viewport{1, 1}, {17, 5}, {1280, 720}, {16384, 100}}) {
        RegionField const field{ImagePlane(viewport)};
        double pixels = 0;
        for (std::uint32_t const index : field.visible()) {
            pixels += double(field.pixels_of(index));
        }
        EXPECT_EQ(pixels, double(viewport.width) * viewport.height);
    }
}

TEST(RegionField, WhereBodiesPassEachOtherThingsMoveThoughTheyLookTheSame) {
    BodyMotions motions;
    motions.extend({7, 0, {{Vec3(0)}, {Vec3(0.1f, 0, 0)}}});
    Learner learner({64, 64});
    learner.bodies.assign(framelet_samples, 7);
    learner.bodies.resize(framelet_samples / 2);
    learner.bodies.resize(framelet_samples, static_body);
    for (bool const moves : {false, true}) {
        learner.moment = {make_view_rays(Camera{}, {64, 64}), 0, moves ? &motions : nullptr};
        learner.learn(learner.patch(3), 1, still);
        learner.learn(learner.patch(3), 2, still);
        EXPECT_EQ(learner.field[0].model.motion > 0, moves);
    }
    learner.bodies.assign(framelet_samples, 7);
    learner.learn(learner.patch(3), 3, still);
    EXPECT_EQ(learner.field[0].model.motion, 0) << "it moves as one";
}

TEST(RegionField, TheSameIsSentOnce) {
    Learner learner({64, 64});
    EXPECT_TRUE(learner.learn(learner.patch(3), 1, still));
    EXPECT_FALSE(learner.learn(learner.patch(3), 2, still));
    EXPECT_EQ(learner.field[0].rendered, 2) << "what is held is true of now";
    EXPECT_EQ(learner.field[0].model.motion, 0);
    EXPECT_TRUE(learner.learn(learner.patch(3), 3, [](float x, float y) { return still(x - 1, y); }));
    EXPECT_GT(learner.field[0].model.motion, 0);
    EXPECT_EQ(learner.field[0].changed, 3);
    EXPECT_TRUE(learner.learn(learner.patch(5), 4, still));
    EXPECT_EQ(learner.field[0].level, 5);
    EXPECT_FALSE(learner.learn(learner.patch(5), 5, still));
}

TEST(RegionField, WhatIsSentThoughItIsTheSameIsWhatTheViewerHolds) {
    Learner learner({64, 64});
    Patch const coarse = learner.patch(3);
    Patch const fine = learner.patch(5);
    EXPECT_TRUE(learner.learn(coarse, 1, still));
    EXPECT_TRUE(learner.learn(fine, 2, still));
    learner.skips = false; // as of what the viewer moves: it takes the place of the finer samples
    EXPECT_TRUE(learner.learn(coarse, 3, still));
    EXPECT_EQ(learner.field[0].level, 3);
    learner.skips = true;
    EXPECT_TRUE(learner.learn(fine, 4, still)) << "or it would never be fine again";
}

/// What a body uncovers may look just as it did, say in the dark.
TEST(RegionField, WhatLooksAsABodyDidThatHasGoneIsSent) {
    BodyMotions const motions;
    for (bool const moves : {false, true}) {
        Learner learner({64, 64});
        learner.moment = {make_view_rays(Camera{}, {64, 64}), 0, moves ? &motions : nullptr};
        learner.bodies.assign(framelet_samples, 7);
        EXPECT_TRUE(learner.learn(learner.patch(5), 1, still));
        EXPECT_EQ(learner.learn(learner.patch(5), 2, still), moves) << "where it is now the viewer does not have it";
        learner.bodies.assign(framelet_samples, static_body);
        EXPECT_EQ(learner.learn(learner.patch(5), 3, still), moves) << "the viewer has moved it away";
        EXPECT_FALSE(learner.learn(learner.patch(5), 4, still));
    }
}

TEST(RegionField, WhatIsAsItWasBeforeTheLastChangeIsSent) {
    auto const other = [](float x, float y) { return 1 - still(x, y); };
    Learner learner({64, 64});
    EXPECT_TRUE(learner.learn(learner.patch(3), 1, still));
    EXPECT_TRUE(learner.learn(learner.patch(4), 2, still));
    EXPECT_TRUE(learner.learn(learner.patch(4), 3, other)) << "a lamp goes on";
    EXPECT_TRUE(learner.learn(learner.patch(3), 4, still)) << "and off: the viewer still shows the other";
    EXPECT_FALSE(learner.learn(learner.patch(3), 5, still));
}

TEST(RegionField, WhatWasRenderedWithNothingToCompareWithMayHaveChanged) {
    auto const other = [](float x, float y) { return 1 - still(x, y); };
    for (bool const moves : {false, true}) {
        Learner learner({64, 64});
        learner.still_since = moves ? 10 : 0;
        EXPECT_TRUE(learner.learn(learner.patch(3), 1, still));
        EXPECT_TRUE(learner.learn(learner.patch(4), 2, moves ? other : still)) << "of this level nothing is known";
        EXPECT_EQ(learner.learn(learner.patch(3), 3, still), moves);
        EXPECT_EQ(learner.field[0].level, moves ? 3 : 4);
    }
}

/// Probes lie in all parts of a region, however many framelets it was rendered as.
TEST(RegionField, ProbesSpreadOverTheRegion) {
    for (Viewport const viewport : {Viewport{64, 64}, {1280, 720}, {4096, 4096}}) {
        Learner learner(viewport);
        for (int level = pixel_level; level < sampling_levels; ++level) {
            learner.learn(learner.patch(level), level, still);
            Region const& region = learner.field[0];
            EXPECT_EQ(region.probe_count, probes_per_region);
            std::array<int, 4> quarters{};
            int const half = learner.field.region_side() / 2;
            for (std::size_t i = 0; i < region.probe_count; ++i) {
                Vec2 const at = region.probes[i].position;
                int const x = at.x < static_cast<float>(half) ? 0 : 1;
                int const y = at.y < static_cast<float>(half) ? 0 : 2;
                ++quarters[static_cast<std::size_t>(x + y)];
                EXPECT_FLOAT_EQ(region.probes[i].luma, static_cast<float>(std::lround(255 * still(at.x, at.y))) / 255);
            }
            EXPECT_EQ(quarters, (std::array{4, 4, 4, 4})) << viewport.width << " level " << level;
        }
    }
}

TEST(RegionField, AStepIsNotMotion) {
    Learner learner({64, 64});
    learner.learn(learner.patch(3), 1, still);
    Region& region = learner.field[0];
    std::vector<float> luma(region.probe_count, 0.9f);
    learn_probes(region, luma, 1.1);
    EXPECT_GT(region.model.motion, 1) << "for all that is known";
    float const drift = region.drift;
    EXPECT_GT(drift, 0);
    learn_probes(region, luma, 1.2);
    EXPECT_LE(region.model.motion, 1.001f) << "it stands";
    EXPECT_GE(region.drift, drift) << "and is not what the viewer has";
    EXPECT_EQ(region.changed, 1.1);
    luma.assign(region.probe_count, 0.2f);
    learn_probes(region, luma, 1.3);
    EXPECT_GT(region.model.motion, 1);
    EXPECT_EQ(region.changed, 1.3);
}

TEST(RegionField, ProbesTellStandingFromMoving) {
    Learner learner({64, 64});
    learner.learn(learner.patch(3), 1, still);
    Region region = learner.field[0];
    std::vector<float> luma;
    for (std::size_t i = 0; i < region.probe_count; ++i) {
        luma.push_back(region.probes[i].luma);
    }
    region.drift = 3;
    learn_probes(region, luma, 2);
    EXPECT_EQ(region.drift, 0);
    EXPECT_EQ(region.checked, 2);
    EXPECT_LT(region.changed, 2);
    luma[3] += 0.2f; // one is enough
    learn_probes(region, luma, 2.5);
    EXPECT_GT(region.drift, 0);
    EXPECT_GT(region.model.motion, 0);
    EXPECT_EQ(region.changed, 2.5);
}

TEST(RegionField, DriftsAsItMovesAndIsBounded) {
    Learner learner({64, 64});
    for (std::uint32_t const index : learner.field.visible()) {
        learner.learn(learner.patch(3, index), 1, still);
    }
    Camera const camera;
    ViewRays const here = make_view_rays(camera, {64, 64});
    Region& region = learner.field[0];
    region.model.motion = 2;
    drift_on(learner.field, here, here, false, 1);
    EXPECT_EQ(region.drift, 0) << "nothing moves";
    drift_on(learner.field, here, here, true, 0.5f);
    EXPECT_FLOAT_EQ(region.drift, 1);
    Camera moved;
    moved.position.x = 0.1f;
    float const before = learner.field[1].drift;
    drift_on(learner.field, here, make_view_rays(moved, {64, 64}), false, 0.5f);
    EXPECT_GT(learner.field[1].drift, before);
    for (int n = 0; n < 1000; ++n) {
        drift_on(learner.field, here, make_view_rays(moved, {64, 64}), true, 1);
    }
    EXPECT_TRUE(std::isfinite(region.drift));
    EXPECT_LE(shown_error(region, 0), unresolved_error(region.model, 3) + drift_bounds(region.model, 3).most * 1.0001f);
    invalidate(learner.field);
    EXPECT_GT(shown_error(region, 0), 0.9f * drift_bounds(region.model, 3).most);
}

/// A step ahead moves what is near over a background that stays where it is.
TEST(RegionField, WhatComesIsNoLessNewThanWhatGoes) {
    Viewport const viewport{512, 512};
    RegionField field{ImagePlane(viewport)};
    int const side = field.region_side();
    ASSERT_LE(side, 64);
    auto const at = [&](int x, int y) -> Region& {
        return field[morton_index(static_cast<std::uint32_t>(x / side), static_cast<std::uint32_t>(y / side))];
    };
    for (std::uint32_t const index : field.visible()) {
        field[index].inverse_depth = 0; // the sky
    }
    for (int y = 192; y < 320; y += side) {
        for (int x = 192; x < 320; x += side) {
            at(x, y).inverse_depth = 0.5f;
        }
    }
    Camera const here;
    Camera ahead = here;
    ahead.position.z -= 1; // half of the way: the thing becomes twice as large
    drift_on(field, make_view_rays(here, viewport), make_view_rays(ahead, viewport), false, 0.02f);
    EXPECT_GT(at(200, 140).drift, 1) << "where the thing is now";
    EXPECT_GT(at(140, 256).drift, 1);
    EXPECT_LT(at(40, 256).drift, 1e-3f) << "where it is not";
    EXPECT_LT(at(256, 480).drift, 1e-3f);
}

} // namespace
} // namespace framelet
