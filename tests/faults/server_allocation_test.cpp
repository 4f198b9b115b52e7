// Lets memory run out anywhere in a running server: at most the session for which it was wanted ends, the others and
// whoever comes next are served, and nothing is kept of who has left.
#include <gtest/gtest.h>

#include "tests/evaluation/soak/process_watch.h"
#include "tests/faults/failing_allocations.h"
#include "tests/session/raw_viewer.h"
#include "tests/session/running_server.h"

namespace framelet::test {
namespace {

constexpr std::size_t places = 2;

/// A viewer of the test's own, whose thread is spared.
class Looker {
public:
    explicit Looker(std::uint16_t port) : port_(port), viewer_(std::make_unique<RawViewer>(port, hello_)) {}

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
        viewer_ = std::make_unique<RawViewer>(port_, hello_);
    }
    void set_clock() { viewer_->send(ClockRequest{ClockRequest::time, {0.5, true, 1}}); }

private:
    std::uint16_t const port_;
    Hello hello_{protocol_version, {}, coding::all, {}, 0};
    std::unique_ptr<RawViewer> viewer_;
    std::uint64_t number_ = 0;
};

/// True where two viewers are served at once before a minute is over; they may be refused while places are being given
/// back.
bool both_are_served(std::uint16_t port) {
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
        Looker first(port), second(port);
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
int busy_moment(std::uint16_t port, Looker& earlier) {
    Looker later(port);
    bool later_goes_on = later.look();
    bool earlier_goes_on = earlier.look();
    earlier.set_clock();
    later_goes_on = later_goes_on && later.look();
    later.come_back();
    later_goes_on = later_goes_on && later.look();
    earlier_goes_on = earlier_goes_on && earlier.look();
    return (later_goes_on ? 1 : 0) + (earlier_goes_on ? 1 : 0);
}

/// The parameter is how many more allocations fail in a row.
class ServerAllocation : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(More, ServerAllocation, testing::Values(0, 4));

TEST_P(ServerAllocation, FailsAndTheOthersGoOn) {
    SparedFromFailure const spared;
    ServerOptions options;
    options.max_sessions = places;
    RunningServer const server(options, moving_scene());
    ASSERT_TRUE(both_are_served(server.port()));
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
        Looker earlier(server.port());
        ASSERT_TRUE(earlier.look());
        FailingAllocation const counts(UINT64_MAX);
        EXPECT_EQ(busy_moment(server.port(), earlier), 2);
        allocations = counts.count();
    }
    int ended = 0;
    for (std::uint64_t const number : sampled_allocations(allocations, GetParam() == 0 ? 80 : 20)) {
        ASSERT_TRUE(both_are_served(server.port())) << "before allocation " << number << " fails";
        ASSERT_TRUE(come_back_to(descriptors)) << "before allocation " << number << " fails";
        {
            Looker earlier(server.port());
            ASSERT_TRUE(earlier.look());
            FailingAllocation const fails(number, GetParam());
            int const go_on = busy_moment(server.port(), earlier);
            EXPECT_GE(go_on, GetParam() == 0 ? 1 : 0) << "both have ended after allocation " << number << " failed";
            ended += 2 - go_on;
        }
    }
    EXPECT_TRUE(both_are_served(server.port()));
    EXPECT_TRUE(come_back_to(descriptors));
    EXPECT_GT(ended, 0) << "some of the allocations were a session's";
}

} // namespace
} // namespace framelet::test
