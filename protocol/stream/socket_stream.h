// Sends and receives messages over a connected socket, plain or with TLS: what is read, what is written, and how it
// ends. In: messages, bytes of the socket. Out: the same the other way; why it ended. stream_opening.cpp alone includes
// it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <sys/socket.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/door_stream.h"
#include "protocol/stream/framed_stream.h"
#include "protocol/stream/handler_slot.h"
#include "protocol/stream/message_frame.h"
#include "protocol/stream/outbox.h"
#include "protocol/stream/stream_reason.h"
#include "protocol/stream/tls.h"

namespace framelet {

namespace asio = boost::asio;

template <typename Stream>
inline constexpr bool is_secure = false;
template <typename Next>
inline constexpr bool is_secure<asio::ssl::stream<Next>> = true;
template <typename Next>
inline constexpr bool is_secure<DoorStream<Next>> = is_secure<Next>;
template <typename Stream>
inline constexpr bool has_door = false;
template <typename Next>
inline constexpr bool has_door<DoorStream<Next>> = true;

/// A connection over `Stream`: asio's TCP socket, or its TLS stream over one, or a DoorStream over either.
template <typename Stream>
class SocketStream final : public FramedStream {
    using Socket = asio::ip::tcp::socket;
    using Error = boost::system::error_code;

public:
    static constexpr std::chrono::seconds handshake_time{10};
    static constexpr std::chrono::seconds ending_time{1};
    static constexpr bool secure = is_secure<Stream>;

    /// `peer`: address of the other side. `role` and `handshakes`, by which the handshake is computed, have a meaning
    /// for TLS only.
    SocketStream(Stream stream, std::string peer, asio::ssl::stream_base::handshake_type role,
                 asio::any_io_executor handshakes)
        : stream_(std::move(stream)), executor_(stream_.get_executor()), handshakes_(std::move(handshakes)),
          handshake_timer_(executor_), ending_timer_(executor_), role_(role), peer_(std::move(peer)) {
        if constexpr (secure) {
            give_up_handshake_where(stream_.native_handle(), finished_);
        }
    }

    void start(Handlers handlers, std::size_t max_body) override {
        FRAMELET_CHECK(!started_);
        started_ = true;
        max_body_ = max_body;
        if (!handlers_.set(std::move(handlers))) {
            return;
        }
        if constexpr (secure) {
            handshake();
        } else {
            open();
        }
    }

    void set_max_body(std::size_t max_body) override { max_body_ = max_body; }

    std::size_t send(Message const& message) override {
        if (handlers_.is_closed() || giving_up_) {
            return 0;
        }
        try {
            if (std::size_t const waiting = outbox_.unsent(); waiting > max_unsent_bytes) {
                throw UnsendableMessage(std::to_string(waiting) +
                                        " bytes wait for the other side to take them, the limit is " +
                                        std::to_string(max_unsent_bytes));
            }
            return post(message);
        } catch (UnsendableMessage const& error) {
            give_up(std::string("this side has a message that cannot be sent: ") + error.what());
        } catch (std::bad_alloc const&) {
            try {
                give_up("this side has no memory left for what it has to send");
            } catch (std::bad_alloc const&) {
                giving_up_ = true; // the other side notices by the silence
            }
        }
        return 0;
    }

    std::size_t unsent_bytes() const override { return outbox_.unsent(); }

    void close_after_sending() override {
        handlers_.take();
        asio::post(executor_, [self = self()] {
            self->contain([&] { self->begin_ending(); });
        }); // queued behind the messages sent before
    }

    void close() override {
        handlers_.take();
        asio::dispatch(executor_, [self = self()] { self->finish(); });
    }

    bool is_stuck() const override {
        return (open_ || shakes_hands_) && !finished_ &&
               ((awaited_reads_ == 0 && !peer_done_) || (awaited_writes_ == 0 && writing_));
    }

    bool was_cut() const override {
        if constexpr (has_door<Stream>) {
            return cut_ && !stream_.was_left();
        }
        return cut_;
    }

    bool asks_for_files() const override {
        if constexpr (has_door<Stream>) {
            return stream_.speaks_http();
        }
        return false;
    }

    std::string peer() const override { return peer_; }

private:
    /// Goes with a handler of asio, and counts it for as long as it exists. A handler whose operation is of several
    /// steps is lost where memory is missing for one of them, without having been called.
    class Awaited {
    public:
        Awaited(std::shared_ptr<SocketStream> connection, std::atomic<int> SocketStream::*count)
            : connection_(std::move(connection)), count_(count) {
            ++(connection_.get()->*count_);
        }
        Awaited(Awaited&&) noexcept = default;
        ~Awaited() {
            if (connection_) {
                --(connection_.get()->*count_);
            }
        }
        SocketStream* operator->() const { return connection_.get(); }

    private:
        std::shared_ptr<SocketStream> connection_; ///< null: it has been moved from
        std::atomic<int> SocketStream::*count_;
    };
    Awaited reading() { return {self(), &SocketStream::awaited_reads_}; }
    Awaited writing() { return {self(), &SocketStream::awaited_writes_}; }

    /// Does the next step; where it fails, mostly because memory is missing for it, this connection ends, and no other.
    template <typename Work>
    void contain(Work const& work) {
        try {
            work();
        } catch (std::exception const& error) {
            finish();
            try {
                bool const memory = dynamic_cast<std::bad_alloc const*>(&error) != nullptr;
                tell(memory ? "no memory left" : error.what()); // the former is short enough to need none
            } catch (std::exception const&) { // whoever was to be told finds it ended
            }
        }
    }

    std::shared_ptr<SocketStream> self() { return std::static_pointer_cast<SocketStream>(shared_from_this()); }

    // --- beginning

    void handshake() {
        shakes_hands_ = true;
        handshake_timer_.expires_after(handshake_time);
        handshake_timer_.async_wait([self = self()](Error error) {
            self->contain([&] {
                if (!error && !self->open_) {
                    self->lose("TLS handshake timed out");
                }
            });
        });
        computes_ = true;
        auto done = [self = reading()](Error error) mutable {
            std::string reason = error ? handshake_reason(error, self->stream_.native_handle()) : std::string();
            asio::any_io_executor const executor = self->executor_;
            asio::post(executor, [self = std::move(self), reason = std::move(reason)] {
                self->computes_ = false;
                self->handshake_timer_.cancel();
                self->contain([&] { self->end_handshake(reason); });
            });
        };
        stream_.async_handshake(role_, asio::bind_executor(handshakes_, std::move(done)));
    }

    void end_handshake(std::string const& reason) {
        if (finished_) {
            close_socket();
        } else if (!reason.empty()) {
            lose(reason);
        } else {
            open();
        }
    }

    void open() {
        if (finished_) {
            return;
        }
        open_ = true;
        read_prefix();
        write_next();
    }

    // --- reading

    void read_prefix() {
        if (ending_) {
            discard();
            return;
        }
        asio::async_read(stream_, asio::buffer(prefix_), [self = reading()](Error error, std::size_t size) {
            self->contain([&] {
                if (error) {
                    self->reading_failed(error, size > 0);
                } else {
                    self->read_body(body_size(self->prefix_));
                }
            });
        });
    }

    void read_body(std::size_t length) {
        if (finished_ || ending_) {
            discard();
            return;
        }
        auto const is_text = [](std::uint8_t c) { return c >= ' ' && c < 0x7f; };
        if (length > max_body_ && first_ && std::all_of(prefix_.begin(), prefix_.end(), is_text)) {
            std::string const said(reinterpret_cast<char const*>(prefix_.data()), prefix_.size());
            refuse("the other side is no framelet program, it says \"" + said + "\": is that the right port?");
            return;
        }
        if (length > max_body_) {
            refuse("a message of " + std::to_string(length) + " bytes exceeds the limit of " +
                   std::to_string(max_body_) + hint());
            return;
        }
        if (body_.size() < length) {
            body_.resize(length);
        }
        asio::async_read(stream_, asio::buffer(body_.data(), length),
                         [self = reading(), length](Error error, std::size_t) {
                             self->contain([&] {
                                 if (error) {
                                     self->reading_failed(error, true);
                                 } else {
                                     self->deliver(ByteView(self->body_.data(), length));
                                 }
                             });
                         });
    }

    void deliver(ByteView body) {
        try {
            if (auto const called = handlers_.get(); called && called->on_message) {
                called->on_message(decode_message(body));
            }
        } catch (std::bad_alloc const&) {
            refuse("this side has no memory left for a message");
            return;
        } catch (std::exception const& error) {
            refuse(error.what());
            return;
        }
        first_ = false;
        if (!finished_) {
            read_prefix();
        }
    }

    /// Reads on and throws away what arrives, because the connection is about to end: a socket that closes with unread
    /// bytes would take back what it sent last.
    void discard() {
        if (finished_) {
            return;
        }
        body_.resize(std::max<std::size_t>(body_.size(), 4096));
        stream_.async_read_some(asio::buffer(body_), [self = reading()](Error error, std::size_t) {
            self->contain([&] {
                if (error) {
                    self->reading_failed(error, false);
                } else {
                    self->discard();
                }
            });
        });
    }

    void reading_failed(Error error, bool within_message) {
        peer_done_ = true;
        if (ending_ && !outbox_.empty()) {
            return; // the peer says no more, but may still listen
        }
        lose(stream_reason(error, within_message) + (within_message ? hint() : ""));
    }

    /// Says what a first message that makes no sense may be: bytes of a TLS record ([RFC 8446] section 5.1).
    std::string hint() const {
        bool const tls = !secure && first_ && prefix_[0] >= 20 && prefix_[0] <= 23 && prefix_[1] == 3;
        return tls ? "; the other side uses TLS and this side does not" : "";
    }

    // --- writing

    std::size_t post(Message const& message) {
        Bytes bytes = frame_of(message);
        std::size_t const size = bytes.size();
        bool const newest_counts = std::holds_alternative<Status>(message);
        outbox_.announce(size);
        asio::post(executor_, [self = self(), bytes = std::move(bytes), newest_counts]() mutable {
            self->contain([&] { self->enqueue(std::move(bytes), newest_counts); });
        });
        return size;
    }

    void enqueue(Bytes bytes, bool newest_counts = false) {
        if (finished_ || ending_ || unwritable_) {
            outbox_.refuse(bytes);
            return;
        }
        if (newest_counts) {
            outbox_.push_newest(std::move(bytes));
        } else {
            outbox_.push(std::move(bytes));
        }
        write_next();
    }

    void write_next() {
        if (!open_ || writing_ || finished_) {
            return;
        }
        if (!outbox_.empty()) {
            writing_ = true;
            ByteView const rest = outbox_.rest();
            stream_.async_write_some(asio::buffer(rest.data(), rest.size()),
                                     [self = writing()](Error error, std::size_t size) {
                                         self->contain([&] { self->wrote(error, size); });
                                     });
        } else if (ending_) {
            say_goodbye();
        }
    }

    void wrote(Error error, std::size_t size) {
        writing_ = false;
        if (finished_) {
            outbox_.release();
            return;
        }
        std::size_t const whole = outbox_.took(size);
        if (error) {
            writing_failed(error);
            return;
        }
        if (whole > 0) {
            if (auto const called = handlers_.get(); called && called->on_sent) {
                called->on_sent(whole);
            }
        }
        write_next();
    }

    /// Writes no more, but reads on: a peer that went away may have said why, and reading finds the end by itself.
    void writing_failed(Error error) {
        unwritable_ = true;
        outbox_.abandon();
        outbox_.release();
        ending_timer_.expires_after(ending_time);
        ending_timer_.async_wait([self = self(), error](Error aborted) {
            self->contain([&] {
                if (!aborted) {
                    self->lose(stream_reason(error, false));
                }
            });
        });
    }

    // --- ending

    /// Ends because the peer broke the protocol: tells both sides why first. Nothing is being read.
    void refuse(std::string const& reason) {
        send_failure(reason);
        discard();
        tell(reason);
    }

    /// Ends because this side cannot go on: tells both sides why first, from any thread. What is being read goes on
    /// being read.
    void give_up(std::string const& reason) {
        giving_up_ = true;
        asio::post(executor_, [self = self(), reason] {
            if (self->finished_ || self->ending_) {
                return;
            }
            self->outbox_.drop_waiting(); // the peer would not get to the reason within the time that is left
            self->contain([&] {
                self->send_failure(reason);
                self->tell(reason);
            });
        });
    }

    void send_failure(std::string const& reason) {
        Bytes failure = frame_of(Failure{reason});
        outbox_.announce(failure.size());
        enqueue(std::move(failure));
        begin_ending();
    }

    /// Ends because the connection is gone.
    void lose(std::string const& reason) {
        cut_ = true;
        finish();
        tell(reason);
    }

    void tell(std::string const& reason) {
        if (auto const called = handlers_.take(); called && called->on_close) {
            called->on_close(reason);
        }
    }

    void begin_ending() {
        if (finished_ || ending_) {
            return;
        }
        if (shakes_hands_ && !open_) { // nothing can be said yet, and what cannot is not worth a handshake
            finish();
            return;
        }
        ending_ = true;
        ending_timer_.expires_after(ending_time);
        ending_timer_.async_wait([self = self()](Error aborted) {
            if (!aborted) {
                self->finish();
            }
        });
        write_next();
    }

    /// Says that no more comes, since all is sent, and leaves the rest to the peer, or to the timer.
    void say_goodbye() {
        if (peer_done_) {
            finish();
            return;
        }
        auto const shut = [self = self()](Error) {
            Error ignored;
            self->stream_.lowest_layer().shutdown(Socket::shutdown_send, ignored);
        };
        if constexpr (secure) {
            stream_.async_shutdown(shut);
        } else {
            shut({});
        }
    }

    void finish() {
        if (finished_) {
            return;
        }
        finished_ = true;
        handshake_timer_.cancel();
        ending_timer_.cancel();
        if (computes_) { // the socket is in use there, but will be no more soon
            ::shutdown(stream_.lowest_layer().native_handle(), SHUT_RDWR);
        } else {
            close_socket();
        }
        outbox_.abandon();
        if (!writing_) {
            outbox_.release();
        }
    }

    void close_socket() {
        Error ignored;
        stream_.lowest_layer().close(ignored);
    }

    Stream stream_;
    asio::any_io_executor const executor_, handshakes_;
    asio::steady_timer handshake_timer_, ending_timer_;
    asio::ssl::stream_base::handshake_type const role_;
    std::string const peer_;

    HandlerSlot handlers_;
    std::atomic<bool> giving_up_ = false; ///< nothing more is sent, for a reason that both sides are about to be told
    Outbox outbox_;

    std::atomic<int> awaited_reads_ = 0, awaited_writes_ = 0; ///< handlers that are still to be called
    std::atomic<bool> finished_ = false; ///< set on the io_context's thread only

    // What follows is only for the io_context's thread.
    std::size_t max_body_ = 0;
    FramePrefix prefix_{};
    Bytes body_; ///< room for the largest message so far
    bool started_ = false;
    bool shakes_hands_ = false; ///< the handshake has begun
    bool open_ = false; ///< the handshake is over
    bool first_ = true; ///< no message has arrived
    bool writing_ = false;
    bool unwritable_ = false; ///< the socket takes no more
    bool ending_ = false; ///< no message is read or queued any more
    bool peer_done_ = false; ///< nothing more will arrive
    bool computes_ = false; ///< `handshakes_` has the socket
    bool cut_ = false;
};

} // namespace framelet
