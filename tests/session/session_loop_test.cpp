// Tests how the loop shares its time among viewers, by what their streams are told: these render nothing, so that the
// renderer is never measured and what it is taken for is known.
#include "server/session/loop/session_loop.h"

#include <atomic>
#include <deque>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "fake_stream.h"
#include "server/scene/motion/animation.h"
#include "triangle_scenes.h"

namespace framelet {
namespace {

/// Script of a stream: what a test says of it, and what it was told.
struct Script {
    std::atomic<bool> takes_more = true; ///< there is something to render, and room for it
    std::atomic<double> samples_per_second = 0; ///< told in its last turn
    std::atomic<double> time_after_change = -1; ///< scene time of the last turn that heard the clock was set; -1: none
};

class ScriptedStream final : public ViewerStream {
public:
    ScriptedStream(Script& script, std::function<void()> on_plan) : script_(script), on_plan_(std::move(on_plan)) {}

    void take(StreamEvent const& event) override {
        clock_changed_ = clock_changed_ || std::holds_alternative<ClockChanged>(event.what);
    }
    Step plan(Turn const& turn, PosedScene&) override {
        if (std::exchange(clock_changed_, false)) {
            script_.time_after_change = turn.present;
        }
        on_plan_();
        script_.samples_per_second = turn.samples_per_second;
        return script_.takes_more ? Step::render : Step::wait;
    }
    SceneTime moment() const override { return 0; }
    void render(PosedScene const&) override {}
    bool learn(PosedScene&) override { return false; }
    EncodedBatch encode() override { return {}; }
    bool is_complete() const override { return false; }
    std::uint64_t last_batch() const override { return 0; }
    TurnFigures const& planned_figures() const override { return figures_; }
    TurnFigures const& learnt_figures() const override { return figures_; }

private:
    Script& script_;
    std::function<void()> const on_plan_;
    TurnFigures const figures_;
    bool clock_changed_ = false;
};

/// A loop with so many viewers.
class RunningLoop {
public:
    /// `lookers`: the first so many have a camera.
    RunningLoop(std::size_t viewers, std::size_t lookers) : scripts_(viewers) {
        for (std::size_t i = 0; i < viewers; ++i) {
            sessions_.push_back(open_session(i));
        }
        for (std::size_t i = 0; i < lookers; ++i) {
            look(i);
        }
        LoopOptions options;
        options.make_stream = [this](StreamOptions const&, std::uint32_t) {
            std::size_t const viewer = streams_++; // in the order of the sessions
            return std::make_unique<ScriptedStream>(scripts_[viewer], [this, viewer] { plan_of(viewer); });
        };
        loop_ = std::make_unique<SessionLoop>(posed_, clock_, std::move(options),
                                              SessionLoop::Events{[this] { return sessions_; }, [] {}});
        thread_ = std::thread([this] { loop_->run(); });
    }
    explicit RunningLoop(std::size_t viewers) : RunningLoop(viewers, viewers) {}
    ~RunningLoop() {
        loop_->stop();
        thread_.join();
    }

    void look(std::size_t viewer) { connections_[viewer]->bring(CameraUpdate{{1, Camera{}, {64, 48}}, -1}); }
    /// How many streams have been made.
    std::size_t streams() const { return streams_; }
    void set_takes_more(std::size_t viewer, bool takes_more) { scripts_[viewer].takes_more = takes_more; }
    /// Has the clock set in the first viewer's turn; returns the scene's time when the second viewer hears of it.
    double time_after_setting(SceneTime time) {
        set_time_ = time;
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (scripts_[1].time_after_change < 0 && std::chrono::steady_clock::now() < end) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return scripts_[1].time_after_change;
    }
    /// Waits until the viewer's share of the time is one of so many; false where that never comes.
    bool shares_among(std::size_t viewer, int sharers) const {
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (scripts_[viewer].samples_per_second != first_samples_per_second / sharers) {
            if (std::chrono::steady_clock::now() > end) {
                return false;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }

private:
    std::shared_ptr<Session> open_session(std::size_t index) {
        FakeConnection const& connection = connections_.emplace_back();
        Session::Events events;
        events.admit = [](Hello const&) { return Welcome{}; };
        events.resize = [](Viewport, bool) { return std::nullopt; };
        events.changed = [] {};
        events.ended = [](std::string const&) {};
        auto session = std::make_shared<Session>(index + 1, connection.stream(), std::move(events));
        session->start();
        connection->bring(Hello{protocol_version, {}, coding::all});
        return session;
    }

    void plan_of(std::size_t viewer) {
        if (double const time = viewer == 0 ? set_time_.exchange(-1) : -1; time >= 0) {
            clock_.apply({ClockRequest::time, {time, false, 1}}, std::chrono::steady_clock::now());
            sessions_[1]->note_clock_change();
        }
    }

    Scene const scene_ = triangle_scene();
    RenderScene render_scene_{scene_, std::nullopt};
    PosedScene posed_{scene_, {}, render_scene_};
    SceneClock clock_{false, std::chrono::steady_clock::now()};
    std::atomic<double> set_time_ = -1;
    std::atomic<std::size_t> streams_ = 0;
    std::vector<Script> scripts_;
    std::deque<FakeConnection> connections_;
    SessionLoop::Sessions sessions_;
    std::unique_ptr<SessionLoop> loop_;
    std::thread thread_;
};

TEST(SessionLoop, TimeIsSharedAmongThoseThatUseIt) {
    RunningLoop loop(3);
    EXPECT_TRUE(loop.shares_among(0, 3));
    loop.set_takes_more(1, false);
    EXPECT_TRUE(loop.shares_among(0, 2)) << "what one cannot use goes to the others";
    EXPECT_TRUE(loop.shares_among(2, 2));
    EXPECT_TRUE(loop.shares_among(1, 3)) << "once it can it is one of three";
    loop.set_takes_more(2, false);
    EXPECT_TRUE(loop.shares_among(0, 1));
    loop.set_takes_more(1, true);
    loop.set_takes_more(2, true);
    EXPECT_TRUE(loop.shares_among(0, 3));
}

TEST(SessionLoop, AViewerHasAStreamOnceItLooksSomewhere) {
    RunningLoop loop(3, 2);
    EXPECT_TRUE(loop.shares_among(0, 2)); // in a turn after one of each
    EXPECT_EQ(loop.streams(), 2u) << "memory is set aside for a viewer when its camera comes";
    loop.look(2);
    EXPECT_TRUE(loop.shares_among(0, 3));
    EXPECT_EQ(loop.streams(), 3u);
}

TEST(SessionLoop, WhoKnowsThatTheClockWasSetIsServedByWhatItWasSetTo) {
    RunningLoop loop(2);
    EXPECT_EQ(loop.time_after_setting(7), 7)
        << "else what is complete would be reported of a time that it does not show";
}

} // namespace
} // namespace framelet
