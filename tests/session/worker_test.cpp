// Workers as a server meets them: those that say what nobody asked of them lose their place, others lose nothing.
#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "raw_viewer.h"
#include "running_server.h"
#include "server/session/welcome.h"
#include "server/workers/order_tracing.h"

namespace framelet {
namespace {

LightOptions const by_paths{LightMethod::reference, 0.53f, 0.1f};

/// A worker's own scene.
struct WorkScene {
    Scene const scene = moving_scene();
    RenderScene render_scene{scene, std::nullopt};
    PosedScene posed{scene, default_clips(scene), render_scene, by_paths};

    Hello hello() const {
        Hello hello{protocol_version, "", coding::none};
        hello.work = {make_welcome(scene, posed.clips()).scene_identity, posed.light_identity(), 1};
        return hello;
    }
};

/// Whose server has paths to trace for as long as the test takes: somebody looks at what moves.
class WorkerTest : public testing::Test {
protected:
    WorkerTest() {
        viewer_.send(CameraUpdate{{1, {}, {64, 48}}});
        looking_ = std::jthread([this] { viewer_.watch([this](Message const&) { return is_over_.load(); }); });
    }
    ~WorkerTest() override { is_over_ = true; }

    static std::optional<PathOrder> next_order(RawViewer& worker) {
        std::optional<PathOrder> order;
        worker.watch([&](Message const& message) {
            auto const* const found = std::get_if<PathOrder>(&message);
            order = found != nullptr ? std::optional(*found) : std::nullopt;
            return found != nullptr;
        });
        return order;
    }
    bool has_workers(std::size_t count) const {
        for (int i = 0; i < 3000 && server.figures().workers != count; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return server.figures().workers == count;
    }

    WorkScene own;
    RunningServer server{{}, moving_scene(), by_paths};

private:
    std::atomic<bool> is_over_ = false;
    RawViewer viewer_{server.port()};
    std::jthread looking_; ///< ends with the next message, once it is over
};

TEST_F(WorkerTest, IsAskedAndAnswers) {
    RawViewer worker(server.port(), own.hello());
    auto const first = worker.receive();
    ASSERT_TRUE(first && std::holds_alternative<Welcome>(*first));
    std::set<std::uint64_t> numbers;
    for (int i = 0; i < 10; ++i) {
        auto const order = next_order(worker);
        ASSERT_TRUE(order);
        EXPECT_TRUE(numbers.insert(order->number).second);
        EXPECT_LE(order->round, order->number);
        EXPECT_FALSE(order->tiles.empty());
        worker.send(trace_order(*own.posed.path_light(), *order));
    }
    EXPECT_EQ(server.figures().workers, 1u);
    EXPECT_EQ(server.figures().sessions, 1u) << "a worker is no viewer";
    EXPECT_EQ(server.figures().viewers, 1u);
}

TEST_F(WorkerTest, WhoAnswersTwiceOrLiesLosesItsPlaceAlone) {
    RawViewer honest(server.port(), own.hello());
    ASSERT_TRUE(next_order(honest));
    auto const is_ended_by = [&](std::function<PathAnswer(PathOrder const&)> const& wrong) {
        RawViewer hostile(server.port(), own.hello());
        EXPECT_TRUE(has_workers(2));
        auto const order = next_order(hostile);
        if (!order) {
            return std::string("no order");
        }
        hostile.send(trace_order(*own.posed.path_light(), *order));
        hostile.send(wrong(*order));
        return hostile.failure();
    };
    EXPECT_NE(is_ended_by([&](PathOrder const& order) { return PathAnswer{order.number, 0, {}}; }), "") << "twice";
    EXPECT_NE(is_ended_by([&](PathOrder const&) { return PathAnswer{1u << 30, 0, {1}}; }), "");
    EXPECT_TRUE(has_workers(1));
    honest.send(CameraUpdate{});
    EXPECT_NE(honest.failure(), "") << "a worker has no camera";
    EXPECT_TRUE(has_workers(0));
    RawViewer viewer(server.port());
    viewer.send(CameraUpdate{{1, {}, {64, 48}}});
    EXPECT_TRUE(viewer.watch([](Message const& message) { return std::holds_alternative<EncodedBatch>(message); }));
}

TEST_F(WorkerTest, AnAnswerThatIsNoLightEndsIt) {
    for (float const wrong : {-5.0f, 1e35f}) {
        RawViewer hostile(server.port(), own.hello());
        bool is_ended = false;
        // An answer that comes too late is not looked at.
        for (int i = 0; i < 1000 && !is_ended; ++i) {
            auto const order = next_order(hostile);
            is_ended = !order;
            if (order) {
                PathAnswer answer{order->number, 0, {}};
                answer.light.assign(order->tiles.size() * sizeof(TileLight) / sizeof(float), wrong);
                hostile.send(answer);
            }
        }
        EXPECT_TRUE(is_ended);
    }
    EXPECT_TRUE(has_workers(0));
}

TEST_F(WorkerTest, ItIsNoViewerWhateverItSaysItReads) {
    Hello both = own.hello();
    both.codings = coding::all;
    RawViewer worker(server.port(), both);
    ASSERT_TRUE(next_order(worker));
    worker.send(CameraUpdate{{1, {}, {64, 48}}});
    EXPECT_NE(worker.failure(), "");
    EXPECT_EQ(server.figures().viewers, 1u);
}

TEST_F(WorkerTest, OfOtherLightItIsTurnedAway) {
    Hello other = own.hello();
    ++other.work->light;
    EXPECT_NE(RawViewer(server.port(), other).failure(), "");
    RunningServer const direct({}, moving_scene());
    EXPECT_NE(RawViewer(direct.port(), own.hello()).failure(), "");
}

TEST(Worker, HasToKnowTheControlToken) {
    ServerOptions options;
    options.token = "a token for those who look";
    options.control_token = "a token for those who may do more";
    WorkScene const own;
    RunningServer const server(options, moving_scene(), by_paths);
    Hello hello = own.hello();
    hello.token = options.token;
    EXPECT_NE(RawViewer(server.port(), hello).failure().find("control token"), std::string::npos);
    hello.token = options.control_token;
    auto const first = RawViewer(server.port(), hello).receive();
    EXPECT_TRUE(first && std::holds_alternative<Welcome>(*first));
}

/// Who does not answer at all is asked for no more than it has, and nobody waits for it.
TEST_F(WorkerTest, WhoIsSilentCostsNothing) {
    RawViewer silent(server.port(), own.hello());
    ASSERT_TRUE(next_order(silent));
    RawViewer viewer(server.port());
    viewer.send(CameraUpdate{{1, {}, {64, 48}}});
    int batches = 0;
    EXPECT_TRUE(viewer.watch([&](Message const& message) {
        batches += std::holds_alternative<EncodedBatch>(message) ? 1 : 0;
        return batches == 10;
    }));
}

} // namespace
} // namespace framelet
