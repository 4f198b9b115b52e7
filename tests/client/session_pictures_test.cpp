#include "client/core/picture/session_pictures.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include "common/picture/reconstruction.h"
#include "tests/picture/fake_canvas.h"
#include "tests/picture/moved_room.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

ImagePlane const plane(Viewport{100, 60});

/// A batch of all framelets at a sample a pixel that begin left of this column of pixels, all of one value.
Batch left_of(int column, std::uint8_t value) {
    Batch batch = make_batch(plane, 1, {});
    for (Tile const tile : visible_tiles(plane, plane.pixel_depth())) {
        if (plane.tile_rect(tile).left < column) {
            batch.framelets.push_back(constant_framelet(plane, tile, value));
        }
    }
    return batch;
}

struct Shown {
    SessionPictures pictures;
    PictureSettings settings;
    NumberedView view{1, {}, plane.viewport(), 1};
    PictureRequest request;
    Picture picture;
    std::vector<PixelRect> changed;

    std::uint64_t batches = 0;

    void insert(Batch batch) {
        batch.number = ++batches;
        pictures.prepare(view, settings).insert(batch);
    }
    /// Begins another session after one of which this was shown.
    void begin_after(Batch const& batch) {
        insert(batch);
        EXPECT_EQ(at(10), batch.framelets[0].red[0]);
        begin_anew();
    }
    void begin_anew() {
        pictures.pause(0);
        pictures.begin_anew();
    }
    int at(int x) {
        pictures.prepare(view, settings);
        pictures.show(request, picture, changed);
        return picture.row(30)[4 * x];
    }
};

/// A batch of the whole picture that is not to be shown before that time.
Batch waiting_until(SceneTime time) {
    Batch batch = left_of(100, 80);
    batch.shown_from = time;
    return batch;
}

/// The value near the left edge of the picture that is shown at this scene time.
int at_time(Shown& shown, SceneTime time) {
    shown.request.present = time;
    return shown.at(10);
}

TEST(PictureMaker, AtRestACameraOfTheSceneIsWhereItsPictureWasTaken) {
    Shown shown;
    Batch batch = left_of(100, 80);
    batch.scene_time = 0.3 / body_keys_per_second;
    batch.view.camera.position.x = 0.5f; // the path between the keys is no straight line
    batch.camera_track = BodyTrack{camera_body(0), 0, std::vector<BodyPose>(3)};
    batch.camera_track->keys[1].translation.x = 1;
    shown.insert(batch);
    shown.request.scene_camera = 0;
    shown.request.camera_number = batch.view.number;
    EXPECT_EQ(at_time(shown, batch.scene_time), 80);
    PictureMaker const& maker = shown.pictures.prepare(shown.view, shown.settings);
    EXPECT_EQ(maker.last_shown().camera, batch.view.camera);
    EXPECT_TRUE(maker.is_exact());
    at_time(shown, 0.6 / body_keys_per_second);
    EXPECT_NEAR(maker.last_shown().camera.position.x, 0.6, 1e-4) << "by its track";
}

TEST(PictureMaker, WhatComesAtRestShowsAsItIsBeforeAllHasCome) {
    AnalyticScene const scene = moving_room();
    ImagePlane const room_plane(viewport);
    auto const rendered = [&](SceneTime time, std::vector<Tile> const& tiles) {
        Batch batch = scene.batch(room_plane, 1, front(), time, tiles);
        batch.view.number = 1;
        return batch;
    };
    Shown shown;
    shown.view = {1, front(), viewport, 1};
    shown.request.camera = front();
    std::vector<Tile> const all = visible_tiles(room_plane, room_plane.pixel_depth());
    Batch first = rendered(0, all);
    first.tracks.push_back(moving_track());
    shown.insert(first);
    shown.insert(rendered(0.5, all));
    at_time(shown, 1); // where it stops
    std::vector<Tile> finest = visible_tiles(room_plane, room_plane.max_depth());
    int const half = viewport.width / 2;
    std::erase_if(finest, [&](Tile tile) { return room_plane.tile_rect(tile).left >= half; });
    Batch const still = rendered(1, finest);
    shown.insert(still);
    at_time(shown, 1);
    FrameletCache exact(room_plane);
    exact.insert(still);
    Picture expected(viewport.width, viewport.height);
    reconstruct_all(exact, expected);
    int wrong = 0;
    for (int y = 0; y < viewport.height; ++y) {
        auto const end = 4 * (half - FrameletCache::block_side); // outlines are filtered across the border
        wrong += std::equal(expected.row(y), expected.row(y) + end, shown.picture.row(y)) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0);
}

TEST(PictureMaker, WhatIsNotToBeShownYetWaits) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(at_time(shown, 1), 50);
    Batch later = waiting_until(1.4);
    later.scene_time = 1.5;
    shown.insert(later);
    EXPECT_EQ(at_time(shown, 1.3), 50);
    EXPECT_EQ(at_time(shown, 1.4), 80);
    shown.insert(later); // late
    EXPECT_EQ(at_time(shown, 1.4), 80);
}

TEST(PictureMaker, WhatWaitsIsShownBeforeWhatComesAfterIt) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(at_time(shown, 1), 50);
    Batch const later = waiting_until(9);
    shown.insert(later);
    EXPECT_EQ(at_time(shown, 1), 50);
    shown.insert(left_of(64, 70));
    EXPECT_EQ(at_time(shown, 1), 70);
    EXPECT_EQ(shown.at(90), 80);
}

TEST(PictureMaker, WhatWaitsIsShownOnceNothingElseIsToCome) {
    Shown shown;
    shown.insert(left_of(100, 50));
    Batch const later = waiting_until(9);
    EXPECT_EQ(at_time(shown, 1), 50);
    shown.insert(later);
    shown.request.is_settled = true;
    EXPECT_EQ(at_time(shown, 1), 80);
}

TEST(PictureMaker, WhatAFastServerRendersBeforeAJumpWaits) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(at_time(shown, 1), 50);
    Batch const later = waiting_until(1.4);
    std::size_t const samples = later.framelets.size() * framelet_samples;
    for (std::size_t sent = 0; sent < 20 * std::size_t{100 * 60}; sent += samples) {
        shown.insert(later);
    }
    EXPECT_EQ(at_time(shown, 1.39), 50);
    EXPECT_EQ(at_time(shown, 1.4), 80);
}

TEST(PictureMaker, AServerThatMakesItWaitForEverDoesNotFillIt) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(at_time(shown, 1), 50);
    Batch const later = waiting_until(1e9);
    std::size_t most = 0;
    for (int i = 0; i < 200; ++i) {
        shown.insert(later);
        most = std::max(most, shown.pictures.memory_bytes());
    }
    EXPECT_LT(most, std::size_t{5} << 18);
    EXPECT_EQ(at_time(shown, 1), 80) << "rather too early";
}

TEST(PictureMaker, BatchesWithoutFrameletsThatWaitAreCounted) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(at_time(shown, 1), 50);
    shown.insert(waiting_until(1e9));
    Batch empty = waiting_until(1e9);
    empty.framelets.clear();
    for (int i = 0; i < 100; ++i) {
        shown.insert(empty);
    }
    EXPECT_EQ(at_time(shown, 1), 50);
    for (int i = 0; i < 100'000; ++i) {
        shown.insert(empty);
    }
    EXPECT_EQ(at_time(shown, 1), 80) << "rather too early than without end";
}

TEST(PictureMaker, NoTracksWait) {
    for (double const lag : {0.0, 0.1}) {
        Shown shown;
        shown.settings.lag_seconds = lag;
        shown.insert(left_of(100, 50));
        shown.request.now = 1;
        EXPECT_EQ(at_time(shown, 1), 50);
        Batch later = waiting_until(lag > 0 ? 0 : 1e9);
        later.scene_time = 1e6;
        later.framelets.resize(1);
        later.tracks.push_back({1, 0, std::vector<BodyPose>(20'000)});
        later.camera_track = later.tracks[0];
        auto const taken = [] { return ::mallinfo2().uordblks + ::mallinfo2().hblkhd; };
        shown.insert(later);
        std::size_t const before = taken();
        for (int i = 0; i < 50; ++i) {
            shown.insert(later);
        }
        EXPECT_LT(taken(), before + later.tracks[0].keys.size() * sizeof(BodyPose)) << lag;
    }
}

TEST(SessionPictures, TheEarlierIsShownUntilTheNewHasNoMoreHoles) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(shown.at(90), 50);
    shown.begin_anew();
    EXPECT_EQ(shown.at(90), 50) << "nothing has come yet";
    shown.insert(left_of(64, 70));
    EXPECT_EQ(shown.at(10), 50) << "they are not mixed";
    shown.insert(left_of(100, 80));
    EXPECT_EQ(shown.at(10), 80);
    EXPECT_EQ(shown.at(90), 80);
}

TEST(SessionPictures, APictureThatLacksNoMoreThanTheEarlierTakesItsPlace) {
    Shown shown;
    shown.begin_after(left_of(64, 50));
    shown.insert(left_of(32, 70));
    EXPECT_EQ(shown.at(10), 50);
    shown.insert(left_of(64, 80));
    EXPECT_EQ(shown.at(10), 80);
}

TEST(SessionPictures, ACompletePictureTakesTheEarliersPlaceHoweverMuchItCovers) {
    Shown shown;
    shown.begin_after(left_of(100, 50));
    shown.insert(left_of(64, 70));
    shown.request.is_settled = true;
    EXPECT_EQ(shown.at(10), 70);
}

TEST(SessionPictures, ManyInterruptionsKeepTheLastPictureThatWasShown) {
    Shown shown;
    shown.begin_after(left_of(100, 50));
    shown.insert(left_of(64, 70));
    EXPECT_EQ(shown.at(10), 50);
    shown.begin_anew();
    EXPECT_EQ(shown.at(90), 50);
    EXPECT_EQ(shown.at(10), 50);
    shown.insert(left_of(100, 80));
    EXPECT_EQ(shown.at(10), 80);
}

TEST(SessionPictures, OfAnEarlierThatIsForgottenNothingIsKept) {
    Shown shown;
    shown.begin_after(left_of(100, 50));
    shown.insert(left_of(64, 70));
    EXPECT_EQ(shown.at(10), 50);
    shown.pictures.forget_earlier();
    EXPECT_EQ(shown.pictures.memory_bytes(), shown.pictures.shown()->memory_bytes());
    EXPECT_EQ(shown.at(10), 70);
}

TEST(SessionPictures, WhatGoesOnIsShownOnAndAddedTo) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(shown.at(90), 50);
    shown.pictures.pause(0);
    EXPECT_EQ(shown.at(90), 50);
    shown.pictures.resume();
    shown.insert(left_of(64, 70));
    EXPECT_EQ(shown.at(10), 70);
    EXPECT_EQ(shown.at(90), 50);
}

TEST(SessionPictures, OfAnotherSizeMeanwhileTheOldOneIsShown) {
    Shown shown;
    shown.insert(left_of(100, 50));
    EXPECT_EQ(shown.at(90), 50);
    shown.pictures.pause(0);
    shown.view = {2, {}, {64, 60}, 2};
    shown.request.camera.position.x = 1;
    EXPECT_EQ(shown.at(10), 50);
    EXPECT_EQ(shown.picture.width, 100);
}

TEST(SessionPictures, OfAnotherSizeTheFirstThatComesIsShown) {
    Shown shown;
    shown.begin_after(left_of(100, 50));
    shown.view = {2, {}, {64, 60}, 2};
    EXPECT_EQ(shown.at(10), 50);
    EXPECT_EQ(shown.picture.width, 100);
    ImagePlane const narrow(shown.view.viewport);
    shown.insert(make_batch(narrow, 1, {constant_framelet(narrow, make_tile(narrow.pixel_depth(), 0, 1), 70)}));
    EXPECT_EQ(shown.at(10), 70);
    EXPECT_EQ(shown.picture.width, 64);
}

TEST(PictureMaker, WhatIsMovedIsPaintedOnTheCanvasAndNothingElse) {
    PictureMaker maker(plane.viewport(), {});
    maker.insert(left_of(100, 50));
    FakeCanvas canvas;
    Picture picture;
    std::vector<PixelRect> changed;
    PictureRequest request;
    EXPECT_TRUE(maker.show(request, picture, changed, &canvas));
    EXPECT_FALSE(maker.last_shown().is_on_canvas) << "nothing has moved";
    request.camera.orientation = glm::angleAxis(0.1f, Vec3(0, 1, 0));
    EXPECT_TRUE(maker.show(request, picture, changed, &canvas));
    EXPECT_TRUE(maker.last_shown().is_on_canvas);
    EXPECT_GT(canvas.painted, 0);
    EXPECT_EQ(picture.width, 100) << "it has the size";
    EXPECT_FALSE(maker.show(request, picture, changed, &canvas)) << "nothing has changed";
    EXPECT_TRUE(maker.last_shown().is_on_canvas);
    canvas.painted = 0;
    maker.set({.lag_seconds = 0.1});
    EXPECT_TRUE(maker.show(request, picture, changed, &canvas));
    EXPECT_FALSE(maker.last_shown().is_on_canvas) << "two pictures are mixed in memory";
    EXPECT_EQ(canvas.painted, 0);
    maker.set({.reproject = false});
    maker.show(request, picture, changed, &canvas);
    EXPECT_FALSE(maker.last_shown().is_on_canvas);
}

/// Two makers take turns on one canvas; it has the picture of one of them at a time.
TEST(SessionPictures, TheSessionBeforeIsOnTheCanvasUntilThisOneIs) {
    Shown shown;
    FakeCanvas canvas;
    shown.request.camera.orientation = glm::angleAxis(0.1f, Vec3(0, 1, 0));
    shown.insert(left_of(100, 50));
    auto const show = [&] {
        shown.pictures.prepare(shown.view, {});
        return shown.pictures.show(shown.request, shown.picture, shown.changed, &canvas);
    };
    EXPECT_TRUE(show());
    EXPECT_TRUE(shown.pictures.shown()->last_shown().is_on_canvas);
    shown.begin_anew();
    shown.insert(left_of(32, 80));
    show();
    EXPECT_TRUE(shown.pictures.shown()->last_shown().is_on_canvas) << "the session before";
    shown.insert(left_of(100, 80));
    canvas.painted = 0;
    EXPECT_TRUE(show());
    EXPECT_TRUE(shown.pictures.shown()->last_shown().is_on_canvas);
    EXPECT_EQ(canvas.painted, 7 * 4) << "this one, all of it";
}

} // namespace
} // namespace framelet
