// A shadow that goes over a floor, shown later than it was seen.
#include <gtest/gtest.h>

#include "common/warp/framelet_warp.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

constexpr float dark = 40, bright = 200;

/// A floor, and just above it a shadow that goes to the right.
AnalyticScene shaded_floor() {
    AnalyticScene scene;
    scene.quads.push_back({{-8, 0, -8}, {16, 0, 0}, {0, 0, 16}, plain(bright, bright, bright)});
    scene.quads.push_back({{-0.8, 1e-6, 0}, {1, 0, 0}, {0, 0, 1.5}, plain(dark, dark, dark)});
    scene.quads[1].velocity = {4, 0, 0};
    return scene;
}

/// A batch whose framelets with some of the shadow in them fade: they change soonest.
Batch batch_at(AnalyticScene const& scene, std::uint64_t number, Camera const& camera, SceneTime time) {
    ImagePlane const plane(viewport);
    Batch batch = scene.batch(plane, number, camera, time, visible_tiles(plane, plane.pixel_depth()));
    for (FrameletShape& shape : batch.shapes) {
        shape.decorrelation = shape.layer_count > 1 ? 180 : 0;
    }
    return batch;
}

struct Counts {
    int right = 0, pixels = 0;

    void add(bool is_right) {
        right += is_right ? 1 : 0;
        ++pixels;
    }
    double share() const { return static_cast<double>(right) / pixels; }
};

struct Agreement {
    Counts shadow, lit;
};

/// Counts, of the pixels that the source saw away from the shadow's rim, those that are shown as they are at the
/// display's time.
Agreement compare(AnalyticScene const& scene, SceneTime from, SceneTime to, Shown const& shown) {
    Agreement out;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            AnalyticScene::Expected const expected =
                scene.expect(front(), from, front(), to, viewport, x + 0.5, y + 0.5, 1.5);
            if (expected.was_seen && expected.hit.quad >= 0) {
                Counts& counts = expected.hit.quad == 1 ? out.shadow : out.lit;
                counts.add(std::abs(shown.picture.row(y)[4 * x] - expected.hit.color[0]) < 2);
            }
        }
    }
    return out;
}

TEST(DriftingShadow, GoesOverWhatIsLitAndStaysDark) {
    AnalyticScene const scene = shaded_floor();
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(batch_at(scene, 1, front(), 0), scene.motions);
    for (double const time : {0.0, 0.05, 0.1, 0.15}) {
        Agreement const got = compare(scene, 0, time, show(pool, front(), time));
        EXPECT_GT(got.shadow.pixels, 500);
        EXPECT_GE(got.shadow.share(), 0.999) << time;
        EXPECT_GE(got.lit.share(), 0.98) << time;
    }
}

TEST(DriftingShadow, GoesOverWhatWasSeenLitSince) {
    AnalyticScene const scene = shaded_floor();
    AnalyticScene lit = scene;
    lit.quads.pop_back();
    ImagePlane const plane(viewport);
    Camera aside = front();
    aside.position.x += 0.02f;
    FrameletPool pool(plane);
    pool.insert(batch_at(scene, 1, front(), 0), scene.motions);
    pool.insert(lit.batch(plane, 2, aside, 0.05, {make_tile(plane.pixel_depth(), 11, 7)}),
                lit.motions); // where the shadow goes
    Agreement const got = compare(scene, 0, 0.15, show(pool, front(), 0.15));
    EXPECT_GE(got.shadow.share(), 0.999);
}

TEST(DriftingShadow, IsNotBelievedForLongAgainstWhatWasSeenSince) {
    AnalyticScene const scene = shaded_floor();
    AnalyticScene lit = scene;
    lit.quads.pop_back();
    Camera aside = front();
    aside.position.x += 0.02f;
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(batch_at(scene, 1, front(), 0), scene.motions);
    pool.insert(batch_at(lit, 2, aside, 0.2), lit.motions);
    Agreement const got = compare(scene, 0, 0.4, show(pool, front(), 0.4));
    EXPECT_GT(got.shadow.pixels, 500);
    EXPECT_LE(got.shadow.share(), 0.001);
}

TEST(DriftingShadow, ShowsNowhereButOnWhatItDarkens) {
    AnalyticScene scene = shaded_floor(); // whose floor ends at x = 1, and the shadow goes on
    scene.quads[0] = {{-8, 0, -8}, {9, 0, 0}, {0, 0, 16}, plain(bright, bright, bright)};
    scene.quads.push_back({{-8, -2, -8}, {16, 0, 0}, {0, 0, 16}, plain(120, 120, 120)});
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(batch_at(scene, 1, front(), 0), scene.motions);
    Shown const shown = show(pool, front(), 0.3);
    int beyond = 0;
    for (int y = 0; y < viewport.height; ++y) {
        for (int x = 0; x < viewport.width; ++x) {
            AnalyticScene::Expected const now =
                scene.expect(front(), 0.3, front(), 0.3, viewport, x + 0.5, y + 0.5, 1.5);
            AnalyticScene::Expected const before =
                scene.expect(front(), 0, front(), 0, viewport, x + 0.5, y + 0.5, 1.5);
            // There the lower floor was seen, and the shadow goes over it in the picture.
            if (now.was_seen && before.was_seen && now.hit.quad == 1 && before.hit.quad == 2) {
                ++beyond;
                EXPECT_NEAR(shown.picture.row(y)[4 * x], 120, 2) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(beyond, 30);
}

/// The number of the shadow's patches that hide what lies behind them, and the number of all its patches.
std::pair<int, int> hiding_patches(FrameletCache const& cache, SceneTime time) {
    BodyMotions const motions;
    Camera const camera = front();
    FrameletWarp warp(cache, 0, {}, camera, time, motions);
    std::vector<Splat> splats;
    std::pair<int, int> out;
    for (std::size_t i = 0; i < cache.slot_count(); ++i) {
        CachedFramelet const* const framelet = cache.at_slot(i);
        for (unsigned k = 0; framelet != nullptr && k < framelet->shape.layer_count; ++k) {
            std::vector<WarpPatch> patches;
            warp.add(*framelet, 1u << k, patches, splats);
            bool const is_shadow = framelet->shape.layers[k].layer.drift.any();
            for (WarpPatch const& patch : patches) {
                out.first += is_shadow && patch.hides ? 1 : 0;
                out.second += is_shadow ? 1 : 0;
            }
        }
    }
    return out;
}

TEST(DriftingShadow, HidesNothingOnceItMayBeElsewhere) {
    AnalyticScene const scene = shaded_floor();
    FrameletPool pool((ImagePlane(viewport)));
    pool.insert(batch_at(scene, 1, front(), 0), scene.motions);
    auto const [young, all] = hiding_patches(pool.newest(), 0.1);
    EXPECT_GT(all, 0);
    EXPECT_EQ(young, all);
    EXPECT_EQ(hiding_patches(pool.newest(), 0.4).first, 0);
}

} // namespace
} // namespace framelet
