#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/error.h"
#include "protocol/stream/handshake_thread.h"
#include "protocol/stream/stream_opening.h"
#include "protocol/stream/tls.h"
#include "random_message.h"
#include "stream_pair.h"
#include "tls_identity.h"

namespace framelet {
namespace {

class TlsStream : public testing::Test {
protected:
    ~TlsStream() override { handshakes_.stop(); }

    std::shared_ptr<FramedStream> server_stream(Socket socket,
                                                std::shared_ptr<boost::asio::ssl::context> const& context) {
        return tls_server_stream(std::move(socket), context, handshakes_.executor());
    }
    std::shared_ptr<FramedStream> server_stream(Socket socket) {
        return server_stream(std::move(socket), identity_.server());
    }
    void expect_names(std::optional<std::string> const& reason, std::string const& words) {
        ASSERT_TRUE(reason);
        EXPECT_NE(reason->find(words), std::string::npos) << *reason;
        EXPECT_EQ(reason->find('\n'), std::string::npos);
    }
    template <typename Function>
    void expect_input_error(Function const& function, std::string const& words) {
        try {
            function();
            ADD_FAILURE() << "accepted, should name " << words;
        } catch (InputError const& error) {
            expect_names(error.what(), words);
        }
    }

    Identity const identity_{"server"};
    HandshakeThread handshakes_;
    IoThread thread_;
    std::pair<Socket, Socket> sockets_ = thread_.connect();
};

TEST_F(TlsStream, ManyMessagesBothWays) {
    for (char const* host : {"localhost", "127.0.0.1"}) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one)));
        End client(tls_client_stream(std::move(two), identity_.client(), host));
        std::vector<Message> sent;
        RandomMessages random(2);
        for (int i = 0; i < 500; ++i) {
            sent.push_back(random.lasting_message());
        }
        sent.push_back(large_batch(1, 20u << 20));
        client.stream->send(sent[0]); // waits for the handshake
        server.start(thread_);
        client.start(thread_);
        std::thread sender([&] {
            for (Message const& message : sent) {
                server.stream->send(message);
            }
        });
        for (std::size_t i = 1; i < sent.size(); ++i) {
            client.stream->send(sent[i]);
        }
        sender.join();
        for (End* const end : {&server, &client}) {
            ASSERT_TRUE(end->wait_for_messages(sent.size()));
            std::vector<Message> const received = end->messages();
            for (std::size_t i = 0; i < sent.size(); ++i) {
                ASSERT_TRUE(same(received[i], sent[i])) << i;
            }
            EXPECT_TRUE(End::eventually([&] { return end->stream->unsent_bytes() == 0; }));
        }
        server.stream->close_after_sending();
        EXPECT_EQ(client.wait_for_close(), "the other side closed the connection");
        EXPECT_TRUE(server.is_released());
    }
}

TEST_F(TlsStream, LastWordArrives) {
    for (int round = 0; round < 20; ++round) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one)));
        End client(tls_client_stream(std::move(two), identity_.client(), "localhost"));
        server.start(thread_);
        client.start(thread_);
        client.stream->send(Hello{});
        ASSERT_TRUE(server.wait_for_messages(1));
        for (std::uint64_t i = 1; i <= 20; ++i) {
            client.stream->send(large_batch(i, 300000)); // will not be read
        }
        server.stream->send(large_batch(1, 3000000));
        server.stream->send(Failure{"the token is wrong"});
        server.stream->close_after_sending();
        EXPECT_TRUE(client.wait_for_close().has_value());
        std::vector<Message> const received = client.messages();
        ASSERT_EQ(received.size(), 2u);
        EXPECT_EQ(std::get<Failure>(received[1]).text, "the token is wrong");
    }
}

TEST_F(TlsStream, GarbageInsideIsRefused) {
    End server(server_stream(std::move(sockets_.first)));
    End client(tls_client_stream(std::move(sockets_.second), identity_.client(), "localhost"));
    server.start(thread_, 100);
    client.start(thread_);
    client.stream->send(large_batch(1, 1000000));
    expect_names(server.wait_for_close(), "exceeds the limit of 100");
    EXPECT_TRUE(client.wait_for_close().has_value());
    std::vector<Message> const received = client.messages();
    ASSERT_EQ(received.size(), 1u);
    expect_names(std::get<Failure>(received[0]).text, "exceeds the limit of 100");
}

TEST_F(TlsStream, WrongHostIsRefused) {
    for (char const* host : {"example.org", "127.0.0.2"}) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one)));
        End client(tls_client_stream(std::move(two), identity_.client(), host));
        server.start(thread_);
        client.start(thread_);
        client.stream->send(Hello{1, "must not leave"});
        auto const reason = client.wait_for_close();
        expect_names(reason, "TLS handshake failed: certificate verify failed");
        expect_names(reason, "mismatch");
        EXPECT_TRUE(server.wait_for_close().has_value());
        EXPECT_TRUE(server.messages().empty());
    }
}

TEST_F(TlsStream, UntrustedCertificateIsRefused) {
    Identity const other("other");
    for (auto const& context : {other.client(), make_tls_client_context("")}) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one)));
        End client(tls_client_stream(std::move(two), context, "localhost"));
        server.start(thread_);
        client.start(thread_);
        expect_names(client.wait_for_close(), "certificate verify failed (self-signed certificate)");
        EXPECT_TRUE(server.wait_for_close().has_value());
    }
}

TEST_F(TlsStream, ACertificateThatThereIsNoMemoryToJudgeIsRefused) {
    auto const context = make_tls_client_context("", [](std::string const&) -> bool { throw std::bad_alloc(); });
    End server(server_stream(std::move(sockets_.first)));
    End client(tls_client_stream(std::move(sockets_.second), context, "localhost"));
    server.start(thread_);
    client.start(thread_);
    expect_names(client.wait_for_close(), "memory");
    EXPECT_TRUE(server.wait_for_close().has_value());
}

TEST_F(TlsStream, HostThatCannotBeChecked) {
    expect_input_error([&] { tls_client_stream(std::move(sockets_.first), identity_.client(), ""); }, "host name");
    expect_input_error(
        [&] { tls_client_stream(std::move(sockets_.second), identity_.client(), std::string(1000, 'x')); },
        "host name");
}

TEST_F(TlsStream, ClientAtAPlainServer) {
    End server(plain_stream(std::move(sockets_.first)));
    End client(tls_client_stream(std::move(sockets_.second), identity_.client(), "localhost"));
    server.start(thread_, max_upstream_message_bytes);
    client.start(thread_);
    expect_names(client.wait_for_close(), "the other side may not use TLS");
    expect_names(server.wait_for_close(), "the other side uses TLS and this side does not");
}

TEST_F(TlsStream, PlainClientAtATlsServer) {
    End server(server_stream(std::move(sockets_.first)));
    End client(plain_stream(std::move(sockets_.second)));
    server.start(thread_);
    client.start(thread_);
    client.stream->send(Hello{});
    expect_names(server.wait_for_close(), "the other side may not use TLS");
    expect_names(client.wait_for_close(), "the other side");
}

TEST_F(TlsStream, PeerVanishesInTheHandshake) {
    End server(server_stream(std::move(sockets_.first)));
    server.start(thread_);
    sockets_.second.close();
    expect_names(server.wait_for_close(), "TLS handshake failed: the other side closed the connection");
}

TEST_F(TlsStream, SilentPeerIsLeft) {
    End server(server_stream(std::move(sockets_.first)));
    server.start(thread_);
    EXPECT_EQ(server.wait_for_close(), "TLS handshake timed out");
}

TEST_F(TlsStream, CloseInTheHandshake) {
    End server(server_stream(std::move(sockets_.first)));
    End client(tls_client_stream(std::move(sockets_.second), identity_.client(), "localhost"));
    server.start(thread_);
    client.start(thread_);
    client.stream->close();
    EXPECT_TRUE(server.wait_for_close().has_value());
    EXPECT_TRUE(client.is_released());
    EXPECT_EQ(client.closes(), 0);
}

TEST_F(TlsStream, CloseWhileMuchIsQueued) {
    for (int round = 0; round < 10; ++round) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one)));
        End client(tls_client_stream(std::move(two), identity_.client(), "localhost"));
        server.start(thread_);
        client.start(thread_);
        client.stream->send(Hello{});
        ASSERT_TRUE(server.wait_for_messages(1));
        for (std::uint64_t i = 1; i <= 8; ++i) {
            server.stream->send(large_batch(i, 1u << 20));
            client.stream->send(large_batch(i, 1u << 20));
        }
        server.stream->close();
        EXPECT_TRUE(client.wait_for_close().has_value());
        EXPECT_TRUE(End::eventually([&] { return server.stream->unsent_bytes() == 0; }));
        EXPECT_TRUE(End::eventually([&] { return client.stream->unsent_bytes() == 0; }));
    }
}

TEST_F(TlsStream, OldVersionsAreRefused) {
    for (auto const& context : {identity_.server(), identity_.client()}) {
        EXPECT_EQ(SSL_CTX_get_min_proto_version(context->native_handle()), TLS1_3_VERSION);
    }
    auto const old = identity_.client();
    SSL_CTX_set_min_proto_version(old->native_handle(), TLS1_2_VERSION);
    SSL_CTX_set_max_proto_version(old->native_handle(), TLS1_2_VERSION);
    SSL_CTX_set_cipher_list(old->native_handle(), "kRSA:ECDHE");
    End server(server_stream(std::move(sockets_.first)));
    End client(tls_client_stream(std::move(sockets_.second), old, "localhost"));
    server.start(thread_);
    client.start(thread_);
    expect_names(server.wait_for_close(), "TLS handshake failed");
    EXPECT_TRUE(client.wait_for_close().has_value());
}

/// What a user may trust is who has signed, and nothing else that may be wrong with a certificate.
TEST_F(TlsStream, WhatIsWrongWhoeverHasSignedIsNotTrusted) {
    bool is_asked = false;
    auto const trusting = make_tls_client_context("", [&is_asked](std::string const&) { return is_asked = true; });
    Identity const expired("expired", -3600);
    for (auto const& [identity, host, words] : {std::tuple(&identity_, "example.org", "mismatch"),
                                                {&identity_, "127.0.0.2", "mismatch"},
                                                {&expired, "localhost", "expired"}}) {
        auto [one, two] = thread_.connect();
        End server(server_stream(std::move(one), identity->server()));
        End client(tls_client_stream(std::move(two), trusting, host));
        server.start(thread_);
        client.start(thread_);
        expect_names(client.wait_for_close(), words);
    }
    EXPECT_FALSE(is_asked);
}

/// What a handshake has come to, as OpenSSL tells it, and on which threads.
struct Steps {
    std::mutex mutex;
    std::set<std::thread::id> threads;
    bool has_answered = false; ///< which is when it signs
};

Steps& steps() {
    static Steps all;
    return all;
}

void note_step(SSL const* ssl, int, int) {
    std::scoped_lock const lock(steps().mutex);
    steps().threads.insert(std::this_thread::get_id());
    steps().has_answered = steps().has_answered || SSL_get_state(ssl) > TLS_ST_SR_CLNT_HELLO;
}

TEST_F(TlsStream, HandshakesAreComputedOnAThreadOfTheirOwn) {
    auto const context = identity_.server();
    SSL_CTX_set_info_callback(context->native_handle(), note_step);
    End server(server_stream(std::move(sockets_.first), context));
    End client(tls_client_stream(std::move(sockets_.second), identity_.client(), "localhost"));
    client.stream->send(Message(Ack{1, 2, 3}));
    server.start(thread_);
    client.start(thread_);
    EXPECT_TRUE(server.wait_for_messages(1));
    std::promise<std::thread::id> own;
    boost::asio::post(thread_.io, [&own] { own.set_value(std::this_thread::get_id()); });
    std::scoped_lock const lock(steps().mutex);
    EXPECT_TRUE(steps().has_answered);
    steps().threads.erase(own.get_future().get()); // where it begins, before there is anything to compute
    EXPECT_EQ(steps().threads.size(), 1u);
}

TEST_F(TlsStream, NothingIsComputedForAConnectionThatHasEnded) {
    auto const context = identity_.server();
    SSL_CTX_set_info_callback(context->native_handle(), note_step);
    std::promise<void> go_on;
    steps().has_answered = false;
    boost::asio::post(handshakes_.executor(), [waits = go_on.get_future().share()] { waits.wait(); });
    End server(server_stream(std::move(sockets_.first), context));
    End client(tls_client_stream(std::move(sockets_.second), identity_.client(), "localhost"));
    server.start(thread_);
    client.start(thread_);
    std::this_thread::sleep_for(std::chrono::milliseconds(200)); // most likely its hello waits to be looked at by then
    server.stream->send(Message(Failure{"too many", true}));
    server.stream->close_after_sending();
    std::promise<void> closed;
    boost::asio::post(thread_.io, [&closed] { closed.set_value(); });
    closed.get_future().wait();
    go_on.set_value();
    EXPECT_TRUE(client.wait_for_close());
    EXPECT_TRUE(server.is_released());
    std::scoped_lock const lock(steps().mutex);
    EXPECT_FALSE(steps().has_answered);
}

TEST_F(TlsStream, FilesThatCannotBeUsed) {
    Identity const other("other");
    std::string const certificate = identity_.certificate_file();
    std::string const key = identity_.key_file();
    expect_input_error([&] { make_tls_server_context("/nowhere.pem", key); },
                       "TLS certificate '/nowhere.pem' cannot be used: there is no such file");
    expect_input_error([&] { make_tls_server_context(certificate, "/nowhere.pem"); }, "TLS key '/nowhere.pem'");
    expect_input_error([&] { make_tls_server_context(key, key); }, "private key, not a certificate");
    expect_input_error([&] { make_tls_server_context(certificate, certificate); }, "certificate, not a private key");
    expect_input_error([&] { make_tls_server_context(certificate, other.key_file()); },
                       "the key of another certificate");
    expect_input_error([&] { make_tls_server_context(certificate, identity_.locked_key_file()); },
                       "it is locked with a password, for which a server cannot ask");
    expect_input_error([&] { make_tls_client_context("/nowhere.pem"); }, "TLS authority '/nowhere.pem'");
    expect_input_error([&] { make_tls_client_context(key); }, "private key, not a certificate");
    std::string const pipe = certificate + ".pipe"; // nobody writes into it, and nobody waits for that
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    expect_input_error([&] { make_tls_server_context(pipe, key); }, "it is not a file");
    expect_input_error([&] { make_tls_server_context(certificate, pipe); }, "it is not a file");
    expect_input_error([&] { make_tls_client_context(pipe); }, "it is not a file");
    expect_input_error([&] { certificate_fingerprint(pipe); }, "it is not a file");
}

} // namespace
} // namespace framelet
