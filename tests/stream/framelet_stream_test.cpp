#include "server/stream/framelet_stream.h"

#include <gtest/gtest.h>

#include "common/held/framelet_pool.h"
#include "tests/session/triangle_scenes.h"

namespace framelet {
namespace {

struct Served {
    Scene scene;
    RenderScene render_scene{scene, std::nullopt};
    PosedScene posed{scene, {0}, render_scene};
    FrameletStream stream;

    explicit Served(StreamOptions const& options = {}, Scene const& what = moving_scene())
        : scene(what), stream(options, coding::all) {
        stream.take({0, ViewerSettings{0, 0, true}});
    }
    void look(Camera const& camera, std::uint64_t number, double now) {
        stream.take({now, CameraUpdate{{number, camera, {64, 48}}, -1}});
    }
    /// Moves the camera at 1 m a second along x from time 0 on; returns when the frame after the last camera begins.
    double fly() {
        double now = 0;
        for (std::uint64_t number = 0; number < 10; now = static_cast<double>(number) / 60) {
            Camera camera;
            camera.position.x = static_cast<float>(now);
            look(camera, ++number, now);
        }
        return now;
    }
    Step plan(double now, SceneTime present, double clock_speed, double plan_seconds = 1e-4, double samples = 1e5) {
        return stream.plan({now, present, clock_speed, samples, plan_seconds}, posed);
    }
};

constexpr double few_samples = 64 * 48; // one a pixel and second
constexpr double in_flight = 1.5; // share of a moment by which it is ahead before a camera that moves

TEST(FrameletStream, AMomentIsOfTheTimeAtWhichItEnds) {
    for (double const speed : {1.0, -2.0, 0.0}) {
        Served served;
        served.look({}, 1, 10);
        ASSERT_EQ(served.plan(10, 0.5, speed), Step::render);
        EXPECT_NEAR(served.stream.moment(), 0.5 + speed * least_moment_seconds, 1e-12);
    }
    Served served;
    served.look({}, 1, 10);
    ASSERT_EQ(served.plan(10, 0.01, -1), Step::render);
    EXPECT_EQ(served.stream.moment(), 0) << "the clock stands there";
}

TEST(FrameletStream, WhatAllIsReplacedIsOfTheMiddleOfTheTimeThatItIsShown) {
    for (double const samples : {1e5, few_samples}) {
        Served served;
        ASSERT_EQ(served.plan(served.fly(), 0.5, 1, 1e-4, samples), Step::render);
        EXPECT_NEAR(served.stream.moment(), 0.5 + in_flight * moment_seconds(samples / (64 * 48)), 1e-9);
    }
    Served served;
    served.look({}, 1, 10);
    ASSERT_EQ(served.plan(10, 0.5, 1, 1e-4, few_samples), Step::render);
    EXPECT_NEAR(served.stream.moment(), 0.5 + least_moment_seconds, 1e-9) << "the camera stands";
}

/// A scene whose triangle stays where it is but for the seconds from 1 to 1.5.
Scene jumping_scene() {
    Scene scene = moving_scene();
    scene.clips[0].channels[0].interpolation = Interpolation::step;
    scene.clips[0].channels[0].times = {0, 1, 1.5f};
    return scene;
}

SceneTime shown_from(Served& served) {
    served.stream.render(served.posed);
    EXPECT_TRUE(served.stream.learn(served.posed));
    return served.stream.learnt_batch().shown_from;
}

TEST(FrameletStream, BeforeAJumpAMomentIsOfWhatComesAfterAndWaits) {
    struct Case {
        SceneTime present;
        double speed;
        SceneTime moment, shown_from;
    };
    for (Case const& wanted : {Case{0.5, 1, 0.6, 0},
                               {0.85, 1, 1, 1},
                               {0.99, 1, 1, 1},
                               {1, 1, 1.1, 0},
                               {0.75, 2, 1, 1},
                               {0.85, 0, 0.85, 0},
                               {0.95, -1, 0.85, 0},
                               {0.3, 8, 1.1, 0}}) {
        Served served({}, jumping_scene());
        served.look({}, 1, 10);
        ASSERT_EQ(served.plan(10, wanted.present, wanted.speed), Step::render);
        EXPECT_NEAR(served.stream.moment(), wanted.moment, 2e-4) << wanted.present;
        EXPECT_EQ(shown_from(served), wanted.shown_from) << wanted.present;
        EXPECT_EQ(served.stream.learnt_batch().outdates, wanted.shown_from > 0);
    }
    Served served({.awaits_switches = false}, jumping_scene());
    served.look({}, 1, 10);
    ASSERT_EQ(served.plan(10, 0.85, 1), Step::render);
    EXPECT_NEAR(served.stream.moment(), 0.95, 1e-9);
    EXPECT_EQ(shown_from(served), 0);
}

TEST(FrameletStream, NoLongMomentIsShownWhenTheSceneJumps) {
    Served served({}, jumping_scene());
    ASSERT_EQ(served.plan(served.fly(), 0.7, 1, 1e-4, few_samples), Step::render);
    EXPECT_NEAR(served.stream.moment(), 0.7 + in_flight * least_moment_seconds, 1e-9);
    EXPECT_EQ(shown_from(served), 0);
}

/// Distance, metres, of the first moment's camera from where the camera is now, which goes 1 m a second.
float rendered_ahead(double plan_seconds, StreamOptions const& options = {}) {
    Served served(options);
    double const now = served.fly();
    EXPECT_EQ(served.plan(now, 0.5, 0, plan_seconds), Step::render);
    served.stream.render(served.posed);
    EXPECT_TRUE(served.stream.learn(served.posed));
    Batch const& batch = served.stream.learnt_batch();
    EXPECT_EQ(batch.view.number, 10u);
    return batch.view.camera.position.x - static_cast<float>(now);
}

TEST(FrameletStream, AMomentsCameraIsAheadOfIt) {
    constexpr double shown_after = in_flight * least_moment_seconds;
    double const quick = shown_after + 0.5 * cycle_length(false, 0); // nothing has been delivered yet
    EXPECT_NEAR(rendered_ahead(0), quick, 1e-4) << "it came a frame ago";
    double const slow = shown_after + 0.01 + 0.5 * cycle_length(false, 0.01);
    EXPECT_NEAR(rendered_ahead(0.01), slow, 1e-4);
    EXPECT_NEAR(rendered_ahead(10), 0.2, 1e-4) << "nobody goes on as they do for long";
    EXPECT_NEAR(rendered_ahead(0, {.camera_leads = false}), shown_after, 1e-4);
    EXPECT_NEAR(rendered_ahead(0, {.looks_ahead = false, .camera_leads = false}), 0, 1e-4);
}

/// The scene that jumps after a second, with a camera that turns about +Y at `speed` radians a second till then.
Scene turning_scene(float speed) {
    Scene scene = jumping_scene();
    scene.nodes.emplace_back();
    scene.cameras.push_back({"turning", 1, Projection::perspective, 0.8f});
    AnimationChannel channel{1, AnimatedProperty::rotation, Interpolation::linear, 4, {}, {}};
    for (int key = 0; key <= 20; ++key) {
        float const time = 0.1f * static_cast<float>(key);
        Quat const turn = glm::angleAxis(speed * (time < 1 ? time : 0.0f), Vec3(0, 1, 0));
        channel.times.push_back(time);
        channel.values.insert(channel.values.end(), {turn.x, turn.y, turn.z, turn.w});
    }
    scene.clips[0].channels.push_back(channel);
    return scene;
}

/// Seconds by which the camera of the moment that begins at `present` is ahead of it, which turns so fast.
double turned_ahead(float speed, double plan_seconds, SceneTime present = 0.3, StreamOptions const& options = {}) {
    Served served(options, turning_scene(speed));
    served.stream.take({0, CameraUpdate{{1, {}, {64, 48}}, 0}});
    EXPECT_EQ(served.plan(0, present, 1, plan_seconds), Step::render);
    served.stream.render(served.posed);
    EXPECT_TRUE(served.stream.learn(served.posed));
    Vec3 const forward = served.stream.learnt_batch().view.camera.forward();
    return std::atan2(-forward.x, -forward.z) / speed - served.stream.learnt_batch().scene_time;
}

TEST(FrameletStream, ACameraOfTheSceneIsAheadOnlyWhereItTurns) {
    double const lead = 0.01 + 0.5 * cycle_length(false, 0.01); // nothing has been delivered yet
    EXPECT_NEAR(turned_ahead(1, 0.01), 2 * lead, 1e-4);
    EXPECT_NEAR(turned_ahead(-1, 0.01), 2 * lead, 1e-4);
    EXPECT_NEAR(turned_ahead(1, 10), least_moment_seconds, 1e-4);
    EXPECT_NEAR(turned_ahead(0.1f, 0.01), 0, 1e-3);
    EXPECT_NEAR(turned_ahead(1, 0.01, 0.75), 0, 1e-4) << "it is not ahead of a jump that the moment is before";
    EXPECT_NEAR(turned_ahead(1, 0.01, 0.3, {.camera_leads = false}), 0, 1e-4);
}

/// Number of framelets of all batches until nothing is left to do. All must be for a viewer that holds what it was sent
/// since this view.
std::size_t sent_until_complete(Served& served, std::uint64_t held_since) {
    std::size_t framelets = 0;
    for (double now = 1; !served.stream.is_complete() && now < 100; now += 0.01) {
        if (served.plan(now, 0.5, 0) != Step::render) {
            continue;
        }
        served.stream.render(served.posed);
        if (served.stream.learn(served.posed)) {
            EXPECT_EQ(served.stream.learnt_batch().view.held_since, held_since);
            framelets += served.stream.learnt_batch().framelets.size();
            std::uint64_t const batch = served.stream.encode().number;
            served.stream.take({now, BatchSent{batch, 100}});
            served.stream.take({now, Ack{batch, 0, 0}});
        }
    }
    EXPECT_TRUE(served.stream.is_complete());
    return framelets;
}

TEST(FrameletStream, AViewerThatHasBegunAnewIsSentAllOfItOnceMore) {
    Served served;
    served.stream.take({0, CameraUpdate{{1, {}, {64, 48}, 1}, -1}});
    std::size_t const all = sent_until_complete(served, 1);
    ASSERT_GT(all, 0u);
    served.stream.take({50, CameraUpdate{{2, {}, {64, 48}, 1}, -1}});
    ASSERT_EQ(served.plan(50, 0.5, 0), Step::nothing) << "it has all";

    served.stream.take({50, CameraUpdate{{3, {}, {32, 32}, 3}, -1}});
    served.stream.take({50, CameraUpdate{{4, {}, {64, 48}, 4}, -1}});
    EXPECT_EQ(sent_until_complete(served, 4), all);

    served.stream.take({50, CameraUpdate{{9, {}, {64, 48}, 9}, -1}}); // nobody has heard of the views between
    ASSERT_EQ(served.plan(200, 0.5, 0), Step::render);
    served.stream.render(served.posed);
    served.stream.take({50, CameraUpdate{{11, {}, {64, 48}, 11}, -1}});
    EXPECT_FALSE(served.stream.learn(served.posed)) << "the viewer would not take that";
    EXPECT_EQ(sent_until_complete(served, 11), all);
}

/// The viewer holds it whatever was rendered of other cameras meanwhile, and however little of it.
TEST(FrameletStream, AViewerHoldsAllOfAPictureAtRestForItsCamera) {
    for (int const batches_away : {0, 1, 2, 5}) {
        Served served;
        FrameletPool pool{ImagePlane({64, 48})};
        BodyMotions motions;
        double now = 1;
        auto const serve = [&](double present) {
            now += 0.02;
            if (served.plan(now, present, 0) != Step::render) {
                return false;
            }
            served.stream.render(served.posed);
            if (served.stream.learn(served.posed)) {
                Batch const& batch = served.stream.learnt_batch();
                for (BodyTrack const& track : batch.tracks) {
                    motions.extend(track);
                }
                pool.insert(batch, motions);
                std::uint64_t const number = served.stream.encode().number;
                served.stream.take({now, BatchSent{number, 100}});
                served.stream.take({now, Ack{number, 0, 0}});
            }
            return true;
        };
        auto const come_to_rest = [&](std::uint64_t number, double present) {
            served.look({}, number, now);
            serve(present);
            for (int i = 0; i < 1000 && !served.stream.is_complete(); ++i) {
                serve(present);
            }
            ASSERT_TRUE(served.stream.is_complete());
            pool.settle();
            EXPECT_EQ(pool.newest().coverage(), 1) << batches_away << " batches away";
        };
        come_to_rest(1, 0.5);
        Camera away;
        away.position.x = 0.5f;
        served.look(away, 2, now);
        for (int batch = 0; batch < batches_away;) {
            batch += serve(0.5) ? 1 : 0;
        }
        come_to_rest(3, 1.5);
    }
}

TEST(FrameletStream, NothingIsPlannedForAViewerThatIsPaused) {
    ViewerSettings const seen{0, 0, true, false};
    ViewerSettings const paused{0, 0, true, true};
    Served served;
    served.look({}, 1, 1);
    ASSERT_EQ(served.plan(1, 0.1, 1), Step::render);
    served.stream.render(served.posed);
    served.stream.take({1, paused});
    EXPECT_EQ(served.plan(1, 0.1, 1), Step::finish) << "what is rendered is sent";
    ASSERT_TRUE(served.stream.learn(served.posed));
    std::uint64_t const batch = served.stream.encode().number;
    served.stream.take({1, BatchSent{batch, 100}});
    served.stream.take({1, Ack{batch, 0, 0}});
    for (double now = 1; now < 3; now += 0.05) {
        ASSERT_EQ(served.plan(now, now, 1), Step::nothing);
        ASSERT_FALSE(served.stream.is_complete());
    }
    served.stream.take({3, seen});
    EXPECT_EQ(served.plan(3, 3, 1), Step::render);
}

TEST(FrameletStream, WhatIsCompleteIsSoAgainAfterAPauseInWhichNothingMoved) {
    Served served;
    served.stream.take({0, CameraUpdate{{1, {}, {64, 48}, 1}, -1}});
    ASSERT_GT(sent_until_complete(served, 1), 0u);
    served.stream.take({101, ViewerSettings{0, 0, true, true}});
    EXPECT_EQ(served.plan(101, 0.5, 0), Step::nothing);
    EXPECT_FALSE(served.stream.is_complete());
    served.stream.take({102, ViewerSettings{0, 0, true, false}});
    EXPECT_EQ(served.plan(102, 0.5, 0), Step::nothing) << "it has all";
    EXPECT_TRUE(served.stream.is_complete());
}

} // namespace
} // namespace framelet
