// A viewer that sends whatever a test wants, in range or not, and reads when it is told to. For tests only; waiting is
// bounded generously and never measured.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <sys/socket.h>

#include "protocol/messages/message.h"
#include "protocol/messages/message_codec.h"

namespace framelet {

class RawViewer {
public:
    explicit RawViewer(std::uint16_t port, std::uint32_t codings = coding::all, std::string const& token = {})
        : RawViewer(port, Hello{protocol_version, token, codings}) {}
    RawViewer(std::uint16_t port, Hello const& hello) : RawViewer(port, Silent{}) {
        RawViewer::write(frame_of(encode_message(hello)));
    }
    virtual ~RawViewer() = default;
    RawViewer(RawViewer const&) = delete;
    RawViewer& operator=(RawViewer const&) = delete;

    /// Does nothing where the server has ended the connection.
    void send(Bytes const& body) { write(frame_of(body)); }
    void send(Message const& message) { send(encode_message(message)); }
    /// Sends no more than the first half of a message.
    void send_half(Message const& message) {
        Bytes frame = frame_of(encode_message(message));
        frame.resize(frame.size() / 2);
        write(frame);
    }

    /// Receives a message; nothing once the connection has ended, or where nothing comes.
    std::optional<Message> receive() {
        std::array<std::uint8_t, 4> prefix{};
        if (!read(prefix.data(), prefix.size())) {
            return std::nullopt;
        }
        std::size_t size = 0;
        for (std::size_t i = 0; i < prefix.size(); ++i) {
            size |= std::size_t{prefix[i]} << (8 * i);
        }
        Bytes body(size);
        return read(body.data(), size) ? std::optional(decode_message(body)) : std::nullopt;
    }

    /// Acknowledges what comes until `done` says so of a message; false where the connection ends before.
    bool watch(std::function<bool(Message const&)> const& done) {
        while (auto const message = receive()) {
            if (auto const* const batch = std::get_if<EncodedBatch>(&*message)) {
                send(Ack{batch->number, 0, 0});
            }
            if (auto const* const failure = std::get_if<Failure>(&*message)) {
                failure_ = failure->text;
            }
            if (done(*message)) {
                return true;
            }
        }
        return false;
    }

    /// Waits for the end of the session and returns what the server says then; empty where the connection ends without
    /// a word.
    std::string failure() {
        watch([](Message const& message) { return std::holds_alternative<Failure>(message); });
        return failure_;
    }

protected:
    struct Silent {};
    /// Connects from this address of the machine, and says nothing.
    RawViewer(std::uint16_t port, Silent,
              boost::asio::ip::address_v4 const& source = boost::asio::ip::address_v4::loopback()) {
        socket_.open(boost::asio::ip::tcp::v4());
        socket_.bind({source, 0});
        socket_.connect({boost::asio::ip::address_v4::loopback(), port});
        timeval const most_wait{30, 0};
        ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &most_wait, sizeof most_wait);
    }

    int socket() { return socket_.native_handle(); }

    /// Does nothing where the connection has ended.
    virtual void write(Bytes const& bytes) {
        boost::system::error_code ignored;
        boost::asio::write(socket_, boost::asio::buffer(bytes), ignored);
    }

    /// Reads by the system's own call, since Asio's takes a timeout for a reason to wait on. False where not as much
    /// comes.
    virtual bool read(void* to, std::size_t size) {
        return ::recv(socket(), to, size, MSG_WAITALL) == static_cast<ssize_t>(size);
    }

private:
    static Bytes frame_of(Bytes const& body) {
        Bytes frame(4);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            frame[i] = static_cast<std::byte>(body.size() >> (8 * i));
        }
        frame.insert(frame.end(), body.begin(), body.end());
        return frame;
    }

    boost::asio::io_context io_{1};
    boost::asio::ip::tcp::socket socket_{io_};
    std::string failure_;
};

} // namespace framelet
