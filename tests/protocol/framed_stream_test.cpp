#include "protocol/stream/framed_stream.h"

#include <atomic>
#include <future>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/web_door.h"
#include "random_message.h"
#include "stream_pair.h"

namespace framelet {
namespace {

/// With and without a door that takes browsers too.
class FramedStreamTest : public testing::TestWithParam<bool> {
protected:
    static std::shared_ptr<FramedStream> opened(Socket socket) {
        return plain_stream(std::move(socket), GetParam() ? std::make_shared<WebPage>() : nullptr);
    }
    void write(Bytes const& bytes) { boost::asio::write(raw, boost::asio::buffer(bytes)); }
    /// The Failure that the stream sent as its only message.
    std::string failure_sent() {
        Bytes const all = read_to_end(raw);
        return all.size() < 4 ? "" : std::get<Failure>(decode_message(ByteView(all).subspan(4))).text;
    }

    IoThread thread_;
    std::pair<Socket, Socket> sockets_ = thread_.connect();
    Socket& raw = sockets_.first; ///< the other side, bare
    End end{opened(std::move(sockets_.second))};
};
INSTANTIATE_TEST_SUITE_P(Door, FramedStreamTest, testing::Bool());

TEST(FramedStream, ManyMessagesBothWays) {
    IoThread thread;
    auto [one, two] = thread.connect();
    End left(plain_stream(std::move(one)));
    End right(plain_stream(std::move(two)));
    left.start(thread);
    right.start(thread);
    constexpr std::size_t count = 2000;
    std::vector<Message> sent;
    RandomMessages random(1);
    for (std::size_t i = 0; i < count; ++i) {
        sent.push_back(random.lasting_message());
    }
    std::thread sender([&] {
        for (Message const& message : sent) {
            right.stream->send(message);
        }
    });
    for (Message const& message : sent) {
        left.stream->send(message);
    }
    sender.join();
    for (End* const end : {&left, &right}) {
        ASSERT_TRUE(end->wait_for_messages(count));
        std::vector<Message> const received = end->messages();
        ASSERT_EQ(received.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_TRUE(same(received[i], sent[i])) << i;
        }
    }
    EXPECT_EQ(left.stream->peer().substr(0, 10), "127.0.0.1:");
}

TEST(FramedStream, MessagesOfSeveralThreadsStayInTheirOrder) {
    IoThread thread;
    auto [one, two] = thread.connect();
    End left(plain_stream(std::move(one)));
    End right(plain_stream(std::move(two)));
    right.start(thread);
    std::vector<std::thread> senders;
    for (std::uint64_t sender = 0; sender < 3; ++sender) {
        senders.emplace_back([&, sender] {
            for (std::uint64_t i = 0; i < 500; ++i) {
                left.stream->send(Ack{i, sender, 0});
            }
        });
    }
    left.start(thread); // messages are sent before and after this
    for (std::thread& sender : senders) {
        sender.join();
    }
    ASSERT_TRUE(right.wait_for_messages(1500));
    std::array<std::uint64_t, 3> next{};
    for (Message const& message : right.messages()) {
        auto const& ack = std::get<Ack>(message);
        EXPECT_EQ(ack.batch, next.at(ack.received_us)++);
    }
}

TEST(FramedStream, LargeMessagesAndTheirCount) {
    IoThread thread;
    auto [one, two] = thread.connect();
    End left(plain_stream(std::move(one)));
    End right(plain_stream(std::move(two)));
    left.start(thread);
    right.start(thread);
    std::size_t bytes = 0;
    for (std::uint64_t i = 1; i <= 4; ++i) {
        EncodedBatch const batch = large_batch(i, i == 2 ? 100 : 20u << 20);
        bytes += 4 + encode_message(batch).size();
        left.stream->send(batch);
    }
    ASSERT_TRUE(right.wait_for_messages(4));
    std::vector<Message> const received = right.messages();
    for (std::uint64_t i = 1; i <= 4; ++i) {
        EXPECT_EQ(std::get<EncodedBatch>(received[i - 1]), large_batch(i, i == 2 ? 100 : 20u << 20));
    }
    EXPECT_TRUE(left.wait_for_sent(bytes));
    EXPECT_TRUE(End::eventually([&] { return left.stream->unsent_bytes() == 0; }));
}

TEST_P(FramedStreamTest, OversizedMessageIsRefusedBeforeItComes) {
    end.start(thread_, max_upstream_message_bytes);
    Bytes prefix(4);
    prefix[2] = std::byte{2}; // 131072
    write(prefix);
    std::string const reason = "a message of 131072 bytes exceeds the limit of 65536";
    EXPECT_EQ(end.wait_for_close(), reason);
    EXPECT_EQ(failure_sent(), reason);
    EXPECT_TRUE(end.messages().empty());
}

TEST_P(FramedStreamTest, LargestPrefixIsRefused) {
    end.start(thread_);
    write(Bytes(4, std::byte{0xff}));
    EXPECT_EQ(end.wait_for_close(), "a message of 4294967295 bytes exceeds the limit of 67108864");
}

TEST_P(FramedStreamTest, AnotherProgramIsSaidToBeOne) {
    if (GetParam()) {
        GTEST_SKIP() << "it is taken for a browser";
    }
    end.start(thread_);
    Bytes answer(4);
    std::memcpy(answer.data(), "HTTP", 4);
    write(answer);
    EXPECT_EQ(end.wait_for_close(), "the other side is no framelet program, it says \"HTTP\": is that the right port?");
}

TEST_P(FramedStreamTest, LimitCanChange) {
    end.start(thread_, 100);
    boost::asio::post(thread_.io, [stream = end.stream] { stream->set_max_body(10000); });
    // The new limit is in force once a message has come through that was sent after it was set.
    write(framed(encode_message(Ack{})));
    ASSERT_TRUE(end.wait_for_messages(1));
    write(framed(encode_message(Failure{std::string(4000, 'x')})));
    EXPECT_TRUE(end.wait_for_messages(2));
}

TEST_P(FramedStreamTest, WhateverFailsForAMessageEndsThatConnection) {
    std::promise<std::string> ended;
    boost::asio::post(thread_.io, [&] {
        end.stream->start({[](Message const&) { throw std::runtime_error("it cannot be done"); },
                           [&](std::string reason) { ended.set_value(std::move(reason)); },
                           {}},
                          max_message_bytes);
    });
    write(framed(encode_message(Ack{})));
    EXPECT_EQ(ended.get_future().get(), "it cannot be done");
    EXPECT_EQ(failure_sent(), "it cannot be done");
}

TEST_P(FramedStreamTest, GarbageIsRefused) {
    end.start(thread_);
    write(framed(Bytes(40, std::byte{0x55})));
    EXPECT_EQ(end.wait_for_close(), "a message is not well-formed");
    EXPECT_EQ(failure_sent(), "a message is not well-formed");
    EXPECT_FALSE(end.stream->was_cut());
}

TEST_P(FramedStreamTest, EmptyMessageIsRefused) {
    end.start(thread_);
    write(Bytes(4));
    EXPECT_EQ(end.wait_for_close(), "a message is not well-formed");
}

TEST_P(FramedStreamTest, RandomBytesNeverGetThrough) {
    end.start(thread_, 1000);
    RandomMessages random(3);
    Bytes bytes(100000);
    for (std::byte& byte : bytes) {
        byte = static_cast<std::byte>(random.any64());
    }
    boost::system::error_code ignored;
    boost::asio::write(raw, boost::asio::buffer(bytes), ignored);
    EXPECT_TRUE(end.wait_for_close().has_value());
    EXPECT_FALSE(failure_sent().empty()) << "the answer arrives although much was never read";
}

TEST_P(FramedStreamTest, TlsBytesAreNamed) {
    end.start(thread_, 65536);
    write({std::byte{22}, std::byte{3}, std::byte{1}, std::byte{2}, std::byte{0}});
    auto const reason = end.wait_for_close();
    ASSERT_TRUE(reason);
    EXPECT_NE(reason->find("the other side uses TLS"), std::string::npos) << *reason;
}

TEST_P(FramedStreamTest, HandlerMayRefuse) {
    auto const reason = std::make_shared<std::promise<std::string>>();
    boost::asio::post(thread_.io, [stream = end.stream, reason] {
        stream->start({[](Message const&) { throw ProtocolError("not now"); },
                       [reason](std::string text) { reason->set_value(std::move(text)); },
                       {}},
                      1000);
    });
    write(framed(encode_message(Ack{})));
    EXPECT_EQ(reason->get_future().get(), "not now");
    EXPECT_EQ(failure_sent(), "not now");
}

TEST_P(FramedStreamTest, WhatCannotBeSentEndsTheConnection) {
    end.start(thread_);
    ClockRequest const late{ClockRequest::time, {8e16, true, 1}};
    EXPECT_EQ(end.stream->send(late), 0u);
    std::string const reason = "this side has a message that cannot be sent: the clock's time is not within 0..1e9";
    EXPECT_EQ(end.wait_for_close(), reason);
    EXPECT_EQ(failure_sent(), reason);
    EXPECT_EQ(end.stream->send(Ack{}), 0u);
    EXPECT_TRUE(end.is_released());
    EXPECT_EQ(end.closes(), 1);
}

TEST_P(FramedStreamTest, TooLargeAMessageEndsTheConnection) {
    end.start(thread_);
    EXPECT_EQ(end.stream->send(large_batch(1, max_message_bytes)), 0u);
    auto const reason = end.wait_for_close();
    ASSERT_TRUE(reason);
    EXPECT_NE(reason->find("exceed the limit of 67108864"), std::string::npos) << *reason;
    EXPECT_EQ(failure_sent(), *reason);
}

TEST_P(FramedStreamTest, OfWaitingStatusTheNewestIsSent) {
    end.start(thread_);
    end.stream->send(large_batch(1, 20u << 20)); // more than the socket takes while nobody reads
    std::size_t const before = end.stream->unsent_bytes();
    for (std::uint64_t i = 1; i <= 1000; ++i) {
        Status status;
        status.last_batch = i;
        end.stream->send(status);
        if (i == 1) {
            end.stream->send(Ack{7, 0, 0});
        }
    }
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() < before + 1000; }));
    end.stream->close_after_sending();
    std::vector<Message> const all = messages_of(read_to_end(raw));
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(std::get<Status>(all[1]).last_batch, 1000u) << "in the place of the first";
    EXPECT_EQ(std::get<Ack>(all[2]).batch, 7u);
}

TEST_P(FramedStreamTest, TooMuchThatWaitsEndsTheConnection) {
    end.start(thread_);
    std::uint64_t sent = 0;
    while (sent < 10 && end.stream->send(large_batch(sent + 1, 30u << 20)) != 0) {
        ++sent;
    }
    EXPECT_EQ(sent, 5u) << "the last that begins within the limit of 128 MiB";
    auto const reason = end.wait_for_close();
    ASSERT_TRUE(reason);
    EXPECT_NE(reason->find("bytes wait for the other side to take them"), std::string::npos) << *reason;
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() < 40u << 20; })) << "and is given up";
    std::vector<Message> const all = messages_of(read_to_end(raw));
    ASSERT_EQ(all.size(), 2u) << "what had begun, and the reason";
    EXPECT_EQ(std::get<Failure>(all[1]).text, *reason);
}

TEST_P(FramedStreamTest, PeerCloses) {
    end.start(thread_);
    write(framed(encode_message(Ack{1, 2, 3})));
    raw.close();
    EXPECT_EQ(end.wait_for_close(), "the other side closed the connection");
    EXPECT_EQ(end.messages().size(), 1u);
    EXPECT_TRUE(end.is_released());
    end.stream->send(Ack{});
    end.stream->close();
    EXPECT_EQ(end.stream->unsent_bytes(), 0u);
    EXPECT_EQ(end.closes(), 1);
}

TEST_P(FramedStreamTest, PeerVanishesInTheMiddle) {
    Bytes const whole = framed(encode_message(Ack{1, 2, 3}));
    for (std::size_t const size : {std::size_t{1}, std::size_t{4}, whole.size() - 1}) {
        auto [one, two] = thread_.connect();
        End other(opened(std::move(two)));
        other.start(thread_);
        boost::asio::write(one, boost::asio::buffer(whole, size));
        one.close();
        EXPECT_EQ(other.wait_for_close(), "the other side closed the connection in the middle of a message");
        EXPECT_TRUE(other.stream->was_cut());
    }
}

TEST_P(FramedStreamTest, PeerResets) {
    end.start(thread_);
    raw.set_option(boost::asio::socket_base::linger(true, 0));
    raw.close();
    EXPECT_EQ(end.wait_for_close(), "connection reset by the other side");
}

TEST_P(FramedStreamTest, PeerVanishesWhileMuchIsQueued) {
    end.start(thread_);
    for (std::uint64_t i = 1; i <= 20; ++i) {
        end.stream->send(large_batch(i, 4u << 20));
    }
    EXPECT_GT(end.stream->unsent_bytes(), 1u << 20);
    raw.close();
    EXPECT_TRUE(end.wait_for_close().has_value());
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() == 0; }));
}

TEST_P(FramedStreamTest, CloseDuringSend) {
    end.start(thread_);
    for (std::uint64_t i = 1; i <= 20; ++i) {
        end.stream->send(large_batch(i, 4u << 20)); // more than the socket takes
    }
    end.stream->close();
    EXPECT_TRUE(end.is_released());
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() == 0; }));
    std::weak_ptr<FramedStream> const watched = end.stream;
    read_to_end(raw);
    end.stream->close();
    EXPECT_EQ(end.closes(), 0) << "our own close is not reported";
}

TEST_P(FramedStreamTest, CloseFromOtherThreadsWhileMessagesArrive) {
    for (int round = 0; round < 30; ++round) {
        auto [one, two] = thread_.connect();
        End left(opened(std::move(one)));
        End right(opened(std::move(two)));
        left.start(thread_);
        right.start(thread_);
        std::vector<std::thread> threads;
        for (End* const side : {&left, &right}) {
            threads.emplace_back([side] {
                for (std::uint64_t i = 0; i < 100; ++i) {
                    side->stream->send(Ack{i, 0, 0});
                }
            });
        }
        threads.emplace_back([&] { left.stream->close(); });
        threads.emplace_back([&] { left.stream->close_after_sending(); });
        for (std::thread& thread : threads) {
            thread.join();
        }
        EXPECT_TRUE(right.wait_for_close().has_value());
        EXPECT_TRUE(left.is_released());
        EXPECT_EQ(left.closes(), 0);
    }
}

TEST_P(FramedStreamTest, CloseBeforeStart) {
    end.stream->close();
    end.start(thread_);
    EXPECT_TRUE(read_to_end(raw).empty());
    EXPECT_TRUE(end.is_released());
}

TEST_P(FramedStreamTest, CloseInsideAHandler) {
    auto const called = std::make_shared<std::promise<void>>();
    auto const kept = std::make_shared<int>(1);
    boost::asio::post(thread_.io, [stream = end.stream, called, kept] {
        stream->start({[stream, called, kept](Message const&) {
                           stream->close();
                           EXPECT_EQ(*kept, 1) << "what runs keeps what it holds";
                           called->set_value(); // a second call would throw
                       },
                       [](std::string const&) { ADD_FAILURE(); },
                       {}},
                      1000);
    });
    Bytes bytes = framed(encode_message(Ack{}));
    bytes.insert(bytes.end(), bytes.begin(), bytes.end());
    write(bytes);
    called->get_future().get();
    read_to_end(raw);
    EXPECT_TRUE(End::eventually([&] { return kept.use_count() == 1; }));
}

TEST_P(FramedStreamTest, CloseAfterSendingSendsAll) {
    end.start(thread_);
    Bytes expected;
    for (std::uint64_t i = 1; i <= 10; ++i) {
        EncodedBatch const batch = large_batch(i, 1u << 20);
        end.stream->send(batch);
        Bytes const bytes = framed(encode_message(batch));
        expected.insert(expected.end(), bytes.begin(), bytes.end());
    }
    end.stream->close_after_sending();
    end.stream->send(Ack{}); // too late
    EXPECT_TRUE(read_to_end(raw) == expected);
    raw.close();
    EXPECT_TRUE(end.is_released());
    EXPECT_EQ(end.closes(), 0);
}

TEST_P(FramedStreamTest, CloseAfterSendingDoesNotWaitForever) {
    end.start(thread_);
    for (std::uint64_t i = 1; i <= 20; ++i) {
        end.stream->send(large_batch(i, 4u << 20));
    }
    end.stream->close_after_sending(); // the peer never reads
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() == 0; }));
}

TEST_P(FramedStreamTest, LastWordArrivesAlthoughThePeerTalks) {
    for (int round = 0; round < 20; ++round) {
        auto [one, two] = thread_.connect();
        End server(opened(std::move(one)));
        End client(opened(std::move(two)));
        server.start(thread_);
        client.start(thread_);
        client.stream->send(Ack{});
        ASSERT_TRUE(server.wait_for_messages(1));
        std::atomic<bool> done = false;
        std::thread talker([&] {
            while (!done) {
                client.stream->send(large_batch(1, 100000));
                std::this_thread::sleep_for(std::chrono::microseconds(200));
            }
        });
        server.stream->send(Failure{"the server is full"});
        server.stream->close_after_sending();
        EXPECT_TRUE(client.wait_for_close().has_value());
        done = true;
        talker.join();
        std::vector<Message> const received = client.messages();
        ASSERT_EQ(received.size(), 1u);
        EXPECT_EQ(std::get<Failure>(received[0]).text, "the server is full");
    }
}

TEST(FramedStream, IoContextMayEndFirst) {
    auto thread = std::make_unique<IoThread>();
    auto [one, two] = thread->connect();
    auto const kept = std::make_shared<int>(1);
    auto stream = plain_stream(std::move(one));
    boost::asio::post(thread->io, [stream, kept] { stream->start({[kept](Message const&) {}, {}, {}}, 1000); });
    stream->send(large_batch(1, 8u << 20));
    two.close();
    stream->close();
    stream.reset();
    thread.reset();
    EXPECT_EQ(kept.use_count(), 1);
}

} // namespace
} // namespace framelet
