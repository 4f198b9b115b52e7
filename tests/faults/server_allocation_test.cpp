// Lets memory run out anywhere in a running server: at most the session for which it was wanted ends, the others and
// whoever comes next are served, and nothing is kept of who has left.
#include <csignal>
#include <optional>

#include <gtest/gtest.h>

#include "tests/evaluation/soak/process_watch.h"
#include "tests/faults/failing_allocations.h"
#include "tests/faults/tls_viewer.h"
#include "tests/protocol/tls_identity.h"
#include "tests/session/running_server.h"

namespace framelet::test {
namespace {

constexpr std::size_t places = 2;

struct Door {
    std::uint16_t port;
    bool tls;
};

/// A viewer of the test's own, whose thread is spared.
class Looker {
public:
    explicit Looker(Door const& door) : door_(door) { connect(); }

    /// True once a batch of a new camera has come; false where the session has ended.
    bool look() {
        viewer_->send(CameraUpdate{{++number_, Camera{}, {64, 48}}, -1});
        return viewer_->watch([this](Message const& message) {
            if (auto const* const welcome = std::get_if<Welcome>(&message)) {
                hello_.ticket = welcome->ticket;
            }
            auto const* const batch = std::get_if<EncodedBatch>(&message);
            hello_.last_batch = batch != nullptr ? batch->number : hello_.last_batch;
            return batch != nullptr && batch->moment && batch->moment->view.number == number_;
        });
    }
    /// Cuts its connection and resumes its session by another.
    void come_back() {
        viewer_.reset();
        connect();
    }
    void set_clock() { viewer_->send(ClockRequest{ClockRequest::time, {0.5, true, 1}}); }

private:
    void connect() {
        if (door_.tls) {
            viewer_ = std::make_unique<TlsViewer>(door_.port, hello_);
        } else {
            viewer_ = std::make_unique<RawViewer>(door_.port, hello_);
        }
    }

    Door const door_;
    Hello hello_{protocol_version, {}, coding::all, {}, 0};
    std::unique_ptr<RawViewer> viewer_;
    std::uint64_t number_ = 0;
};

/// True where two viewers are served at once before a minute is over; they may be refused while places are being given
/// back.
bool both_are_served(Door const& door) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
        Looker first(door), second(door);
        if (first.look() && second.look()) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

/// Waits until the process has so many descriptors: they come back a moment after a connection has ended. False where
/// that takes more than a minute.
bool come_back_to(std::size_t descriptors) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (bench::holdings_of(::getpid()).descriptors != descriptors) {
        if (std::chrono::steady_clock::now() > deadline) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

/// Does what is done while an allocation may fail: one viewer was there before, one comes, sees something and comes
/// back. Returns how many of the two sessions go on.
int busy_moment(Door const& door, Looker& earlier) {
    Looker later(door);
    bool later_goes_on = later.look();
    bool earlier_goes_on = earlier.look();
    earlier.set_clock();
    later_goes_on = later_goes_on && later.look();
    later.come_back();
    later_goes_on = later_goes_on && later.look();
    earlier_goes_on = earlier_goes_on && earlier.look();
    return (later_goes_on ? 1 : 0) + (earlier_goes_on ? 1 : 0);
}

struct Missing {
    std::uint64_t more; ///< allocations that fail in a row after the first
    std::size_t samples; ///< how often some fail, about
    bool tls;
};

class ServerAllocation : public testing::TestWithParam<Missing> {};
INSTANTIATE_TEST_SUITE_P(Missing, ServerAllocation,
                         testing::Values(Missing{0, 80, false}, Missing{4, 20, false}, Missing{0, 60, true},
                                         Missing{4, 20, true}));

TEST_P(ServerAllocation, FailsAndTheOthersGoOn) {
    SparedFromFailure const spared;
    std::signal(SIGPIPE, SIG_IGN); // as the server does
    auto const [more, samples, tls] = GetParam();
    ServerOptions options;
    options.max_sessions = places;
    std::optional<Identity> identity;
    if (tls) {
        identity.emplace("server");
        options.tls_certificate = identity->certificate_file();
        options.tls_key = identity->key_file();
    }
    RunningServer const server(options, moving_scene());
    Door const door{server.port(), tls};
    ASSERT_TRUE(both_are_served(door));
    std::size_t const descriptors = [&] {
        std::size_t least = 1000;
        for (int i = 0; i < 400; ++i) { // by then the descriptors of the viewers before are closed
            least = std::min(least, bench::holdings_of(::getpid()).descriptors);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return least;
    }();
    std::uint64_t allocations = 0;
    {
        Looker earlier(door);
        ASSERT_TRUE(earlier.look());
        FailingAllocation const counts(UINT64_MAX);
        EXPECT_EQ(busy_moment(door, earlier), 2);
        allocations = counts.count();
    }
    int ended = 0;
    for (std::uint64_t const number : sampled_allocations(allocations, samples)) {
        ASSERT_TRUE(both_are_served(door)) << "before allocation " << number << " fails";
        ASSERT_TRUE(come_back_to(descriptors)) << "before allocation " << number << " fails";
        {
            Looker earlier(door);
            ASSERT_TRUE(earlier.look());
            FailingAllocation const fails(number, more);
            int const go_on = busy_moment(door, earlier);
            EXPECT_GE(go_on, more == 0 ? 1 : 0) << "both have ended after allocation " << number << " failed";
            ended += 2 - go_on;
        }
    }
    EXPECT_TRUE(both_are_served(door));
    EXPECT_TRUE(come_back_to(descriptors));
    EXPECT_GT(ended, 0) << "some of the allocations were a session's";
}

} // namespace
} // namespace framelet::test
