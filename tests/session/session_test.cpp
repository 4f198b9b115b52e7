#include "server/session/session.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace framelet {
namespace {

/// A connection without a socket: the test says what comes.
class FakeStream : public FramedStream {
public:
    void start(Handlers handlers, std::size_t) override { handlers_ = std::move(handlers); }
    void set_max_body(std::size_t) override {}
    std::size_t send(Message const&) override { return 0; }
    std::size_t unsent_bytes() const override { return 0; }
    void close_after_sending() override {}
    void close() override {}
    std::string peer() const override { return "nobody"; }

    void bring(Message const& message) { handlers_.on_message(message); }

private:
    Handlers handlers_;
};

TEST(Session, AFloodOfWhatAViewerLetsGoOfIsBounded) {
    constexpr std::size_t most_waiting = std::size_t{1} << 18;
    auto const stream = std::make_shared<FakeStream>();
    Session::Events events;
    events.admit = [](Hello const&) { return Welcome{}; };
    events.changed = [] {};
    events.ended = [](std::string const& reason) { FAIL() << reason; };
    auto const session = std::make_shared<Session>(1, stream, events);
    session->start();
    stream->bring(Hello{protocol_version, {}, coding::all});
    LetGo const full{std::vector<SentTile>(max_let_go, {1, Tile{5}})};
    auto const waiting = [&] {
        std::vector<StreamEvent> came;
        session->take_events(came);
        return std::ranges::count_if(
            came, [](StreamEvent const& event) { return std::holds_alternative<LetGo>(event.what); });
    };
    for (std::size_t i = 0; i < 2 * most_waiting / max_let_go; ++i) {
        stream->bring(full);
    }
    EXPECT_EQ(waiting(), most_waiting / (max_let_go + 1));
    for (std::size_t i = 0; i < 2 * most_waiting; ++i) { // of nothing, each still takes memory
        stream->bring(LetGo{});
    }
    EXPECT_EQ(waiting(), most_waiting);
    stream->bring(full);
    EXPECT_EQ(waiting(), 1) << "what has been taken makes room";
}

} // namespace
} // namespace framelet
