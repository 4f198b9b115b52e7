// Tests of how a session is opened, or is not, and how it ends.
#include <thread>

#include <gtest/gtest.h>

#include "tests/client/tested_core.h"

namespace framelet {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(ClientCore, SaysThatNobodyListens) {
    ConnectionOptions options;
    {
        FakeServer const server;
        options = options_for(server);
    }
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {options.server.text(), "connection refused", "framelet-server"})) << text;
}

TEST(ClientCore, SaysThatThereIsNoSuchHost) {
    ConnectionOptions options;
    options.server = {"nowhere.invalid", 7070};
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {"nowhere.invalid:7070"})) << text;
}

/// What fails on the connection's own thread is said on the one that asked for it.
TEST(ClientCore, SaysThatNoCertificateCouldNameSuchAHost) {
    FakeServer const server;
    ConnectionOptions options = options_for(server);
    options.server.host.clear(); // the loopback, to the resolver
    options.tls = true;
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {"cannot go on", "host name", "certificate"})) << text;
}

TEST(ClientCore, GivesUpOnAServerThatDoesNotAnswer) {
    FakeServer::Script script;
    script.mute = true;
    FakeServer server(script);
    ConnectionOptions options = options_for(server);
    options.connect_seconds = 0.3;
    std::string const text = why_not(options);
    EXPECT_TRUE(one_line_with(text, {options.server.text(), "no answer"})) << text;
}

TEST(ClientCore, SaysWhatTheServerRefusedItFor) {
    FakeServer::Script script;
    script.refusal = "wrong token: ask whoever runs the server";
    FakeServer server(script);
    std::string const text = why_not(options_for(server));
    EXPECT_TRUE(one_line_with(text, {server.address().text(), "refused", "wrong token"})) << text;
}

TEST(ClientCore, RefusesAnotherProtocolVersion) {
    FakeServer::Script script;
    script.welcome.version = 77;
    FakeServer server(script);
    std::string const text = why_not(options_for(server));
    EXPECT_TRUE(one_line_with(text, {server.address().text(), "77", "version"})) << text;
}

TEST(ClientCore, TellsARefusalFromAServerThatIsNotThereYet) {
    FakeServer::Script script;
    script.refusal = "wrong token: ask whoever runs the server";
    ConnectionOptions options;
    {
        FakeServer server(script);
        options = options_for(server);
        EXPECT_THROW(ClientCore{options}, ConnectionRefusal);
    }
    try {
        ClientCore const core(options);
        FAIL() << "nobody listens";
    } catch (ConnectionRefusal const& error) {
        FAIL() << error.what();
    } catch (ConnectionError const&) {
    }
}

TEST(ClientCore, SendsItsTokenFirst) {
    FakeServer server;
    ConnectionOptions options = options_for(server);
    options.token = "open sesame";
    ClientCore const core(options);
    ASSERT_EQ(server.received<Hello>().size(), 1u);
    EXPECT_EQ(server.received<Hello>().front().token, "open sesame");
}

TEST(ClientCore, GarbageAndHostileLengthsEndTheConnection) {
    std::string const garbage[] = {std::string(1000, '\xff'), "HTTP/1.1 400 Bad Request\r\n\r\n",
                                   std::string("\xff\xff\xff\x7f", 4), std::string(4, '\0'),
                                   std::string("\x10\0\0\0", 4) + std::string(16, 'x')};
    for (std::string const& bytes : garbage) {
        FakeServer::Script script;
        script.raw_bytes = bytes;
        FakeServer server(script);
        ConnectionOptions options = options_for(server);
        options.connect_seconds = 30;
        std::string const text = why_not(options);
        EXPECT_TRUE(one_line_with(text, {server.address().text()})) << text;
        EXPECT_EQ(text.find("no answer"), std::string::npos) << text;
    }
}

TEST(ClientCore, ServerThatBreaksTheProtocolIsLeft) {
    FakeServer chatty;
    ClientCore core(options_for(chatty));
    chatty.send(Message(Hello{})); // only viewers say that
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {chatty.address().text(), "protocol"})) << *core.end_reason();

    ImagePlane const plane(Viewport{32, 32});
    FakeServer broken;
    ClientCore second(options_for(broken));
    second.set_view({}, plane.viewport());
    EncodedBatch encoded =
        BatchCodec().encode(make_batch(plane, 1, {constant_framelet(plane, make_tile(plane.pixel_depth(), 0, 0), 1)}));
    encoded.payload.resize(encoded.payload.size() / 2);
    broken.send(Message(encoded));
    ASSERT_TRUE(wait_for(second, [&] { return second.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*second.end_reason(), {broken.address().text(), "protocol"})) << *second.end_reason();
}

TEST(ClientCore, NoticesThatTheServerVanished) {
    FakeServer server;
    ClientCore core(options_for(server));
    server.vanish();
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text()})) << *core.end_reason();
    core.set_view({}, {32, 32}); // may be called still, to no effect
}

TEST(ClientCore, SaysFarewell) {
    FakeServer server;
    { ClientCore const core(options_for(server)); }
    ASSERT_TRUE(server.wait_for_some<Failure>());
}

TEST(ClientCore, NoticesThatTheServerFellSilent) {
    FakeServer server;
    ConnectionOptions options = options_for(server);
    options.silence_seconds = 1;
    ClientCore core(options);
    core.wait_for_news(1500ms); // heartbeats keep it
    EXPECT_FALSE(core.end_reason().has_value());
    server.fall_silent();
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text(), "stopped answering"}));
}

TEST(ClientCore, PassesOnWhyTheServerEndedTheSession) {
    FakeServer server;
    ClientCore core(options_for(server));
    server.send(Message(Failure{"the server is shutting down"}));
    ASSERT_TRUE(wait_for(core, [&] { return core.end_reason().has_value(); }));
    EXPECT_TRUE(one_line_with(*core.end_reason(), {server.address().text(), "shutting down"})) << *core.end_reason();
}

} // namespace
} // namespace framelet
