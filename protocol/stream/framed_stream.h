// Connections: length-prefixed messages over TCP, with or without TLS. Whoever knows sockets and bytes is behind this;
// how one is made of a socket is in stream_opening.h, apart, since few need the sockets and their headers are long.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "protocol/messages/message.h"

namespace framelet {

/// The largest number of bytes that may wait for the other side to take them: two of the largest messages. A live peer
/// that reads is never so far behind.
inline constexpr std::size_t max_unsent_bytes = 2 * max_message_bytes;

/// One connection. All members are called from the io_context's thread (there is one), except where said otherwise, and
/// all callbacks come from it. No callback begins after `close` or `close_after_sending` returned or `on_close` was
/// called, and what the callbacks hold is released then; only one that runs in the io_context's thread while another
/// thread calls `close` may still finish.
class FramedStream : public std::enable_shared_from_this<FramedStream> {
public:
    struct Handlers {
        /// Called with each message that arrives. Whatever exception it throws ends the connection like a message that
        /// cannot be decoded: the peer is sent what it says.
        std::function<void(Message)> on_message;
        /// Called once, when the connection ends for whatever reason but our own `close`; `reason` is one line.
        std::function<void(std::string reason)> on_close;
        /// Called when a queued message has gone to the socket; `bytes` with its prefix.
        std::function<void(std::size_t bytes)> on_sent;
    };

    virtual ~FramedStream() = default;

    /// Begins the connection: TLS handshake where there is one (10 s at most), then reading. Messages larger than
    /// `max_body` bytes and such that break the protocol end the connection; the peer is sent a Failure that says why.
    virtual void start(Handlers handlers, std::size_t max_body) = 0;
    virtual void set_max_body(std::size_t max_body) = 0;
    /// Queues a message and returns its bytes, prefix included; does nothing, and returns 0, once the connection has
    /// ended. Messages of one thread stay in order, but that of Status messages that wait the newest alone is sent, in
    /// the place of the first. A message that is out of range, or comes when more than `max_unsent_bytes` wait, is not
    /// sent and ends the connection; the peer is sent a Failure that says why. May be called from any thread.
    virtual std::size_t send(Message const& message) = 0;
    /// Bytes queued or handed to the socket and not yet taken by it. May be called from any thread.
    virtual std::size_t unsent_bytes() const = 0;
    /// Sends what is queued (for at most a second), then ends; what still arrives is not looked at. May be called from
    /// any thread.
    virtual void close_after_sending() = 0;
    /// Ends the connection at once. May be called from any thread.
    virtual void close() = 0;
    /// True where memory was missing for the next step of reading or writing, so that neither goes on and nobody is
    /// told. May be called only between callbacks.
    virtual bool is_stuck() const { return false; }
    /// True where the connection is gone without a word of either side, who might meet again. Means something once
    /// `on_close` was called.
    virtual bool was_cut() const { return false; }
    /// True where the other side speaks HTTP and opens no session. To be called on the io_context's thread.
    virtual bool asks_for_files() const { return false; }
    /// Address and port of the other side, as they were at the beginning. May be called from any thread.
    virtual std::string peer() const = 0;
};

} // namespace framelet
