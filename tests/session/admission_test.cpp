#include "server/session/admission.h"

#include <gtest/gtest.h>

#include "fake_stream.h"

namespace framelet {
namespace {

class AdmissionTest : public testing::Test {
protected:
    /// What a viewer that says this is answered.
    Welcome enter(std::uint64_t id, FakeConnection const& connection, Hello const& hello) {
        Welcome answer;
        Session::Events events;
        events.admit = [&](Hello const& said) {
            admission_.seat(sessions_.back(), said, answer);
            return answer;
        };
        events.changed = [] {};
        events.ended = [](std::string const&) {};
        sessions_.push_back(std::make_shared<Session>(id, connection.stream(), std::move(events)));
        sessions_.back()->start();
        connection->bring(hello);
        return answer;
    }

    FakeConnection connections_[3];
    std::vector<std::shared_ptr<Session>> sessions_;
    Admission admission_{{"", "", false, std::size_t{1} << 30}, [] {}};
};

TEST_F(AdmissionTest, WhoWasCutGoesOn) {
    Hello hello{protocol_version, {}, coding::all};
    hello.ticket = enter(1, connections_[0], hello).ticket;
    connections_[0]->lose("cut", true);
    EXPECT_TRUE(enter(2, connections_[1], hello).resumed);
}

/// The cut of a connection is known to its session before the server has come to it.
TEST_F(AdmissionTest, WhoWasCutAsTheSceneWasReplacedBeginsAnew) {
    Hello hello{protocol_version, {}, coding::all};
    hello.ticket = enter(1, connections_[0], hello).ticket;
    connections_[0]->lose("cut", true);
    admission_.forget_viewers(0);
    admission_.leave(1, sessions_[0].get());
    EXPECT_FALSE(enter(2, connections_[1], hello).resumed);
    EXPECT_FALSE(sessions_[0]->is_served());
}

} // namespace
} // namespace framelet
