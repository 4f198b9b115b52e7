#include "common/picture/reprojector.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/color.h"
#include "common/framelet/sample_worth.h"
#include "common/picture/reconstruction.h"
#include "tests/picture/moved_room.h"

namespace framelet {
namespace {

TEST(ReprojectorRest, StillPictureIsReconstruct) {
    ImagePlane const plane(viewport);
    std::mt19937 random(4);
    FrameletPool pool(plane);
    AnalyticScene const scene = room();
    Reprojector reprojector;
    Picture picture(viewport.width, viewport.height), expected = picture;
    std::vector<PixelRect> changed, repainted;
    for (std::uint64_t number = 1; number < 40; ++number) {
        std::vector<Tile> tiles;
        for (int i = 0; i < 20; ++i) {
            Tile const tile = random_tile(plane, random);
            if (std::ranges::find(tiles, tile) == tiles.end()) {
                tiles.push_back(tile);
            }
        }
        pool.insert(scene.batch(plane, number, front(), 0.1 * static_cast<double>(number), tiles), scene.motions);
        pool.newest().take_changed(changed);
        reprojector.show(pool, changed, front(), 7, {}, picture, repainted);
        reconstruct_all(pool.newest(), expected);
        ASSERT_TRUE(reprojector.is_exact());
        ASSERT_EQ(picture, expected);
    }
    reprojector.show(pool, {}, front(), 8, {}, picture, repainted);
    EXPECT_TRUE(repainted.empty());
}

TEST(ReprojectorRest, BodiesThatHaveComeToRestAreExact) {
    AnalyticScene scene = room();
    BodyTrack track{5, 0, {}};
    for (int i = 0; i <= 60; ++i) { // moves until 0.5 s
        auto const time = static_cast<float>(std::min(i, 30)) / body_keys_per_second;
        track.keys.push_back({Vec3(0.6f * time, 0, 0), glm::angleAxis(0.7f * time, Vec3(0, 0, 1)), Vec3(1)});
    }
    scene.motions.extend(track);
    scene.quads[2].body = 5;
    FrameletPool const pool = filled(scene, front(), 2, 0.55);
    Picture exact(viewport.width, viewport.height);
    reconstruct_all(pool.newest(), exact);
    EXPECT_EQ(show(pool, front(), 0.9, scene.motions).picture, exact);
    EXPECT_NE(show(pool, front(), 0.2, scene.motions).picture, exact);
}

TEST(ReprojectorRest, AfterACutWhatIsHeldStaysWhereItIs) {
    AnalyticScene const scene = room();
    FrameletPool const pool = filled(scene, front(), 0);
    Picture unmoved(viewport.width, viewport.height);
    reconstruct_all(pool.newest(), unmoved);
    Camera away = front();
    away.orientation = glm::angleAxis(3.0f, Vec3(0, 1, 0)) * away.orientation;
    Camera aside = front();
    aside.orientation = glm::angleAxis(0.3f, Vec3(0, 1, 0)) * aside.orientation;
    Reprojector reprojector;
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> repainted;
    for (Camera const& camera : {aside, away, away, aside, front(), away}) {
        reprojector.show(pool, {}, camera, 0, {}, picture, repainted);
        if (camera == aside) {
            EXPECT_EQ(picture, show(pool, aside, 0).picture);
        } else {
            EXPECT_EQ(picture, unmoved);
            EXPECT_EQ(reprojector.hole_share(), camera == away ? 1 : 0);
        }
    }
}

TEST(ReprojectorRest, ACutIsMovedWhereThatIsWished) {
    FrameletPool const pool = filled(room(), front(), 0);
    Camera away = front();
    away.orientation = glm::angleAxis(3.0f, Vec3(0, 1, 0)) * away.orientation;
    Reprojector kept, moved({.keeps_cuts = false});
    Picture of_kept(viewport.width, viewport.height), of_moved = of_kept;
    std::vector<PixelRect> repainted;
    kept.show(pool, {}, away, 0, {}, of_kept, repainted);
    moved.show(pool, {}, away, 0, {}, of_moved, repainted);
    EXPECT_EQ(moved.hole_share(), 1);
    EXPECT_NE(of_moved, of_kept);
}

/// Shows cameras and contents that change now and then: what is kept from the last picture is right, whatever the
/// threads.
TEST(ReprojectorRest, IncrementalEqualsWholeAndThreadsMakeNoDifference) {
    ImagePlane const plane(viewport);
    AnalyticScene scene = room();
    scene.motions.extend({5, 0, {BodyPose{}, BodyPose{Vec3(2, 0, 0)}, BodyPose{Vec3(-1, 0.1f, 0)}}});
    scene.quads[2].body = 5;
    std::mt19937 random(12);
    FrameletPool pool(plane);
    Reprojector kept;
    Picture picture(viewport.width, viewport.height);
    std::vector<PixelRect> changed, repainted;
    Camera camera = front();
    int partial = 0;
    for (std::uint64_t number = 1; number < 40; ++number) {
        std::vector<Tile> tiles = number == 1 ? visible_tiles(plane, plane.pixel_depth()) : std::vector<Tile>{};
        for (int i = 0; i < 6; ++i) {
            Tile const tile = random_tile(plane, random);
            if (std::ranges::find(tiles, tile) == tiles.end()) {
                tiles.push_back(tile);
            }
        }
        double const time = static_cast<double>(number / 4) / body_keys_per_second;
        Batch batch = scene.batch(plane, number, camera, time, tiles);
        for (FrameletShape& shape : batch.shapes) {
            shape.decorrelation =
                decorrelation_code(number % 3 == 0 ? 0.0f : std::exp2(static_cast<float>(random() % 8)));
        }
        pool.insert(batch, scene.motions);
        if (number % 5 == 0) {
            camera.position += Vec3(0.05f, 0.02f, -0.1f);
        }
        for (double const later : {0.3, 0.02, -0.04, 0.01}) { // the same samples, worn more or less
            pool.newest().take_changed(changed);
            kept.show(pool, changed, camera, time + later, scene.motions, picture, repainted);
            ASSERT_EQ(picture, show(pool, camera, time + later, scene.motions).picture) << number << ' ' << later;
        }
        pool.newest().take_changed(changed);
        Picture const before = picture;
        kept.show(pool, changed, camera, time, scene.motions, picture, repainted);
        Shown whole;
        {
            tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, number % 2 == 0 ? 1 : 2);
            whole = show(pool, camera, time, scene.motions);
        }
        ASSERT_EQ(picture, whole.picture) << number;
        if (!kept.is_exact()) {
            ASSERT_TRUE(std::ranges::equal(kept.inverse_depth(), whole.inverse_depth));
        }
        std::vector<std::uint8_t> covered(static_cast<std::size_t>(viewport.width * viewport.height));
        std::size_t area = 0;
        for (PixelRect const& rect : repainted) {
            for (int y = rect.top; y < rect.bottom; ++y) {
                for (int x = rect.left; x < rect.right; ++x) {
                    covered[at(x, y)] = 1;
                    ++area;
                }
            }
        }
        partial += area < covered.size() ? 1 : 0;
        for (std::size_t i = 0; i < covered.size(); ++i) {
            if (covered[i] == 0) {
                ASSERT_TRUE(std::equal(&picture.rgba[4 * i], &picture.rgba[4 * i] + 4, &before.rgba[4 * i]));
            }
        }
        kept.show(pool, {}, camera, time, scene.motions, picture, repainted);
        ASSERT_TRUE(repainted.empty());
        ASSERT_EQ(picture, whole.picture);
    }
    EXPECT_GT(partial, 20);
}

TEST(ReprojectorRest, NoShapeLeavesWhatIsNotANumber) {
    ImagePlane const plane(viewport);
    std::mt19937 random(7);
    std::array const strange{NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e17f, 1e-40f, 0.0f};
    auto const any = [&] { return strange[random() % strange.size()]; };
    AnalyticScene const scene = room();
    Camera aside = front();
    aside.position.x += 0.2f;
    for (int round = 0; round < 24; ++round) {
        int const levels = round % 4 - 1;
        Batch batch =
            scene.batch(plane, 1, front(), 0, visible_tiles(plane, plane.pixel_depth() + levels), round % 5 == 0);
        for (FrameletShape& shape : batch.shapes) {
            for (Layer& layer : shape.layers) {
                std::array const fields{&layer.at,
                                        &layer.dx,
                                        &layer.dy,
                                        &layer.error,
                                        &layer.drift.corner.velocity.x,
                                        &layer.drift.velocity_dy.y};
                *fields[random() % fields.size()] = any();
            }
            for (Outlier& outlier : shape.outliers) {
                (random() % 2 == 0 ? outlier.inverse_depth : outlier.drift.velocity.z) = any();
            }
        }
        FrameletPool pool(plane);
        pool.insert(batch, scene.motions);
        Shown const shown = show(pool, round % 3 == 0 ? front() : aside, 0.1);
        for (std::size_t i = 0; i < shown.inverse_depth.size(); ++i) {
            ASSERT_TRUE(std::isfinite(shown.inverse_depth[i]));
        }
    }
}

TEST(ReprojectorRest, OrthographicStays) {
    AnalyticScene const scene = room();
    Camera orthographic = front();
    orthographic.projection = Projection::orthographic;
    orthographic.vertical_extent = 5;
    FrameletPool const pool = filled(scene, orthographic, 0);
    Camera aside = orthographic;
    aside.position.x += 1;
    Picture expected(viewport.width, viewport.height);
    reconstruct_all(pool.newest(), expected);
    EXPECT_EQ(show(pool, aside, 0).picture, expected);
}

/// A block that stands in its place and ends beyond the picture's border has nothing there, rather than something black
/// that is farther than all else: of that the holes beside it would be made.
TEST(Reprojector, HolesAtTheBorderAreNotFilledFromBeyondIt) {
    ImagePlane const plane({320, 184});
    AnalyticScene const scene = room();
    FrameletPool pool(plane);
    std::vector<Tile> tiles = visible_tiles(plane, plane.pixel_depth());
    Camera before = front();
    before.position.x += 0.5f;
    pool.insert(scene.batch(plane, 1, before, 0, {tiles.front()}), scene.motions);
    std::erase_if(tiles, [](Tile tile) { return tile.row() == 11 && tile.column() >= 9 && tile.column() <= 11; });
    pool.insert(scene.batch(plane, 2, front(), 0, tiles), scene.motions);
    Picture picture(320, 184);
    std::vector<PixelRect> repainted;
    Reprojector reprojector;
    reprojector.show(pool, {}, front(), 0, {}, picture, repainted);
    ASSERT_GT(reprojector.hole_share(), 0);
    ASSERT_FALSE(reprojector.is_exact());
    for (int y = 176; y < 184; ++y) {
        for (int x = 144; x < 192; ++x) {
            std::uint8_t const* const pixel = picture.row(y) + 4 * x;
            ASSERT_GT(pixel[0] + pixel[1] + pixel[2], 30) << x << ' ' << y;
        }
    }
}

} // namespace
} // namespace framelet
