// Lets memory run out anywhere in a viewer: a call throws, or the session ends and another begins, or nothing is
// missed; what goes on comes to the exact picture.
#include <gtest/gtest.h>

#include "client/core/client_core.h"
#include "common/command_line/program_failure.h"
#include "common/error.h"
#include "tests/faults/failing_allocations.h"
#include "tests/loopback/process.h"
#include "tests/protocol/tls_identity.h"

namespace framelet::test {
namespace {

constexpr Viewport viewport{96, 64};

ConnectionOptions options_of(std::string const& address) {
    ConnectionOptions options;
    options.server = parse_server_address(address);
    options.reconnect = true;
    return options;
}

/// Updates the picture until it is complete; false where that does not come.
bool come_to_rest(ClientCore& core, Picture& picture) {
    std::vector<PixelRect> changed;
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
        bool const complete = core.is_complete();
        core.update_picture(picture, changed);
        if (complete) {
            return true;
        }
        core.wait_for_news(std::chrono::milliseconds(20));
    }
    return false;
}

enum class Outcome { complete, thrown, not_complete };

/// Connects, looks somewhere, then elsewhere. The core is gone afterwards, whatever has happened.
Outcome look(ConnectionOptions const& options, Picture& picture) {
    try {
        ClientCore core(options);
        core.set_view(core.welcome().start_camera, {64, 48});
        std::vector<PixelRect> changed;
        for (int i = 0; i < 3; ++i) {
            core.wait_for_news(std::chrono::milliseconds(50));
            core.update_picture(picture, changed);
        }
        core.set_view(core.welcome().start_camera, viewport);
        return come_to_rest(core, picture) ? Outcome::complete : Outcome::not_complete;
    } catch (std::exception const&) {
        return Outcome::thrown;
    }
}

/// The parameter says whether the connection is of TLS.
class ClientAllocation : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Tls, ClientAllocation, testing::Values(false, true));

TEST_P(ClientAllocation, FailsAndIsSaidOrMadeUpFor) {
    std::vector<std::string> server_options{"--paused", "--exposure", "0", "--insecure"};
    Identity const identity("server");
    if (GetParam()) {
        server_options.insert(server_options.end(),
                              {"--tls-cert", identity.certificate_file(), "--tls-key", identity.key_file()});
    }
    ServerProcess const server(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb", server_options);
    ConnectionOptions options = options_of(server.address());
    options.tls = GetParam();
    options.authority_file = GetParam() ? identity.certificate_file() : "";
    Picture exact;
    ASSERT_EQ(look(options, exact), Outcome::complete);
    std::uint64_t allocations = 0;
    {
        FailingAllocation const counts(UINT64_MAX);
        Picture again;
        ASSERT_EQ(look(options, again), Outcome::complete);
        ASSERT_EQ(again, exact);
        allocations = counts.count();
    }
    std::int64_t const live = live_allocations();
    int complete = 0, thrown = 0;
    for (std::uint64_t const number : sampled_allocations(allocations, 60)) {
        Picture picture;
        Outcome outcome{};
        {
            FailingAllocation const fails(number);
            outcome = look(options, picture);
        }
        ASSERT_NE(outcome, Outcome::not_complete) << "after allocation " << number << " failed";
        if (outcome == Outcome::complete) {
            EXPECT_EQ(picture, exact) << "after allocation " << number << " failed";
            ++complete;
        } else {
            ++thrown;
        }
    }
    EXPECT_GT(complete, 1) << "it comes back by itself after some";
    EXPECT_GT(thrown, 1) << "some were the painter's";
    EXPECT_LT(live_allocations() - live, thrown / 2) << "what has failed gives back what it had";
}

TEST(ClientAllocation, GoesAwayWhateverFails) {
    ServerProcess const server(FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb",
                               {"--paused", "--exposure", "0", "--insecure"});
    std::int64_t live = 0;
    for (std::uint64_t number = 1; number <= 30; ++number) {
        auto core = std::make_unique<ClientCore>(options_of(server.address()));
        core->set_view(core->welcome().start_camera, {64, 48});
        core->wait_for_news(std::chrono::milliseconds(50));
        {
            FailingAllocation const fails(number, UINT64_MAX);
            core.reset();
        }
        live = number == 1 ? live_allocations() : live;
    }
    EXPECT_LT(live_allocations() - live, 15) << "what has failed gives back what it had";
}

TEST(ClientAllocation, ProgramsSayWhatIsMissing) {
    EXPECT_NE(std::string(failure_text(std::bad_alloc())).find("memory"), std::string::npos);
    EXPECT_STREQ(failure_text(ConnectionError("gone")), "gone");
}

} // namespace
} // namespace framelet::test
