// Lets memory run out while one viewer's stream is at work: that stream throws and is gone; another of the same scene
// goes on to the byte as if nothing had been.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "protocol/messages/message_codec.h"
#include "server/scene/scene_import.h"
#include "server/stream/framelet_stream.h"
#include "tests/faults/failing_allocations.h"

namespace framelet::test {
namespace {

constexpr Viewport viewport{160, 96};
constexpr int turns = 24;

struct PlayedScene {
    Scene scene = import_scene(FRAMELET_SOURCE_DIR "/scenes/windmill.glb");
    RenderScene render_scene{scene, std::nullopt};
    PosedScene posed{scene, default_clips(scene), render_scene};
};

/// One viewer's stream, on a clock of its own making.
class PlayedStream {
public:
    /// `offset`: how far its camera is from that of another stream, metres.
    explicit PlayedStream(float offset) : offset_(offset), stream_(StreamOptions{}, coding::all) {}

    /// Plays what comes before the turn, and the turn as a whole; what the stream sends goes into `bytes`. The link is
    /// narrow, so that there is loss, prediction, and something to send once more.
    void play(int turn, PosedScene& scene, Bytes& bytes) {
        double const now = 0.02 * turn;
        if (turn == 0) {
            stream_.take({now, ViewerSettings{0, 0, true}});
        }
        if (turn % 3 == 0 && turn < turns / 2) {
            Camera const camera =
                look_at({6 + offset_ + 0.1f * static_cast<float>(turn), 4, 12}, {0, 2, 0}, {0, 1, 0}, 0.9f);
            stream_.take({now, CameraUpdate{{++cameras_, camera, viewport}, -1}});
        }
        if (turn == turns / 2) {
            stream_.take({now, ClockChanged{}});
        }
        for (auto const& [number, sent] : std::exchange(unanswered_, {})) {
            stream_.take({now, BatchSent{number, sent}});
            auto const microseconds = static_cast<std::uint64_t>(1e6 * (now + 1e-7 * static_cast<double>(sent)));
            stream_.take({now, Ack{number, microseconds, 100}});
        }
        bool const plays = turn < turns / 2;
        SceneTime const present = plays ? now : 0.02 * turns / 2;
        Step const step = stream_.plan({now, present, plays ? 1.0 : 0.0, 2e5, 1e-4}, scene);
        if (step != Step::render) {
            return;
        }
        scene.pose(stream_.moment());
        stream_.render(scene);
        if (stream_.learn(scene)) {
            EncodedBatch const batch = stream_.encode();
            Bytes const body = encode_message(batch);
            bytes.insert(bytes.end(), body.begin(), body.end());
            unanswered_.emplace_back(batch.number, body.size());
        }
    }

private:
    float const offset_;
    std::uint64_t cameras_ = 0;
    std::vector<std::pair<std::uint64_t, std::size_t>> unanswered_;
    FrameletStream stream_;
};

struct Played {
    Bytes failing, other; ///< what the two have sent
    bool failed = false;
    std::uint64_t allocations = 0; ///< of the stream that may fail, until it did
};

/// Plays two streams in turn; the first one's allocation of this number fails.
Played play(PlayedScene& scene, std::uint64_t number) {
    Played played;
    PlayedStream other(0.5f);
    std::optional<PlayedStream> failing;
    FailingAllocation fails(number);
    for (int turn = 0; turn < turns; ++turn) {
        if (!played.failed) {
            try {
                if (!failing) {
                    failing.emplace(0.0f);
                }
                failing->play(turn, scene.posed, played.failing);
            } catch (std::exception const&) {
                played.failed = true;
                failing.reset();
            }
        }
        fails.suspend(true);
        other.play(turn, scene.posed, played.other);
        fails.suspend(false);
    }
    played.allocations = fails.count();
    EXPECT_EQ(played.failed, fails.has_failed()) << "allocation " << number << " is not missed in silence";
    return played;
}

/// The parameter is the number of threads: one, where the same allocation is the same one each time, and several.
class StreamAllocation : public testing::TestWithParam<std::size_t> {
    tbb::global_control const threads_{tbb::global_control::max_allowed_parallelism, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Threads, StreamAllocation, testing::Values(1, 4));

TEST_P(StreamAllocation, FailsAndTheOtherStreamGoesOn) {
    PlayedScene scene;
    Played const whole = play(scene, UINT64_MAX);
    ASSERT_FALSE(whole.failed);
    ASSERT_GT(whole.other.size(), 10'000u);
    ASSERT_EQ(play(scene, UINT64_MAX).other, whole.other) << "the same again, to begin with";
    std::int64_t const live = live_allocations();
    std::int64_t failures = 0;
    for (std::uint64_t const number : sampled_allocations(whole.allocations, 100)) {
        Played const played = play(scene, number);
        failures += played.failed ? 1 : 0;
        ASSERT_EQ(played.other, whole.other) << "after allocation " << number << " failed";
        if (!played.failed) {
            EXPECT_EQ(played.failing, whole.failing);
        }
    }
    EXPECT_GT(failures, 50);
    EXPECT_LT(live_allocations() - live, failures / 2) << "what has failed gives back what it had";
}

/// Nothing of a pose half taken shows, whether it or the one before is wanted next.
TEST_P(StreamAllocation, APoseThatCouldNotBeTakenDoesNotShow) {
    constexpr SceneTime times[] = {0, 0.7};
    PlayedScene scene;
    Camera const camera = look_at({6, 4, 12}, {0, 2, 0}, {0, 1, 0}, 0.9f);
    auto const picture_at = [&](SceneTime time) {
        scene.posed.pose(time);
        return render_picture(scene.render_scene, camera, viewport, 1, 1);
    };
    Picture const pictures[] = {picture_at(times[0]), picture_at(times[1])};
    ASSERT_NE(pictures[0], pictures[1]);
    std::uint64_t allocations = 0;
    {
        FailingAllocation const counts(UINT64_MAX);
        scene.posed.pose(times[0]);
        allocations = counts.count();
    }
    for (std::uint64_t const number : sampled_allocations(allocations, 60)) {
        for (int const next : {0, 1}) {
            ASSERT_EQ(picture_at(times[0]), pictures[0]);
            {
                FailingAllocation const fails(number);
                try {
                    scene.posed.pose(times[1]);
                    EXPECT_FALSE(fails.has_failed()) << number;
                } catch (std::bad_alloc const&) {
                    EXPECT_TRUE(fails.has_failed());
                }
            }
            ASSERT_EQ(picture_at(times[next]), pictures[next]) << "after allocation " << number << " failed";
        }
    }
}

} // namespace
} // namespace framelet::test
