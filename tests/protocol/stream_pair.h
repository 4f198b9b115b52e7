// Two connected sockets on the loopback, an io_context on a thread of its own, and an end of a stream that notes what
// happens to it. For tests only; waiting is bounded generously and never measured.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "protocol/messages/message_codec.h"
#include "protocol/stream/stream_opening.h"

namespace framelet {

using Socket = StreamSocket;

class IoThread {
public:
    IoThread() : guard_(boost::asio::make_work_guard(io)), thread_([this] { io.run(); }) {}
    ~IoThread() {
        guard_.reset();
        io.stop();
        thread_.join();
    }
    IoThread(IoThread const&) = delete;
    IoThread& operator=(IoThread const&) = delete;

    /// Both ends of one connection.
    std::pair<Socket, Socket> connect() {
        using boost::asio::ip::tcp;
        tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
        Socket client(io);
        client.connect(acceptor.local_endpoint());
        return {acceptor.accept(), std::move(client)};
    }

    boost::asio::io_context io;

private:
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> guard_;
    std::thread thread_;
};

/// Notes all callbacks of one stream.
class End {
public:
    explicit End(std::shared_ptr<FramedStream> opened) : stream(std::move(opened)) {}
    ~End() { stream->close(); }
    End(End const&) = delete;
    End& operator=(End const&) = delete;

    void start(IoThread& thread, std::size_t max_body = max_message_bytes) {
        boost::asio::post(thread.io, [stream = stream, notes = notes_, max_body] {
            stream->start(
                {[notes](Message message) { notes->add([&] { notes->messages.push_back(std::move(message)); }); },
                 [notes](std::string reason) {
                     notes->add([&] {
                         ++notes->closes;
                         notes->reason = std::move(reason);
                     });
                 },
                 [notes](std::size_t bytes) { notes->add([&] { notes->sent += bytes; }); }},
                max_body);
        });
    }

    bool wait_for_messages(std::size_t count) {
        return notes_->wait([&] { return notes_->messages.size() >= count; });
    }
    /// Waits for the end of the stream and returns its reason; nothing if the end does not come.
    std::optional<std::string> wait_for_close() {
        return notes_->wait([&] { return notes_->closes > 0; }) ? std::optional(notes_->reason) : std::nullopt;
    }
    bool wait_for_sent(std::size_t bytes) {
        return notes_->wait([&] { return notes_->sent >= bytes; });
    }
    std::vector<Message> messages() {
        std::scoped_lock const lock(notes_->mutex);
        return notes_->messages;
    }
    int closes() {
        std::scoped_lock const lock(notes_->mutex);
        return notes_->closes;
    }
    /// True once nothing but this object refers to the notes: the stream has let go of its callbacks.
    bool is_released() {
        return eventually([&] { return notes_.use_count() == 1; });
    }

    static bool eventually(std::function<bool()> const& holds) {
        for (int i = 0; i < 3000; ++i) {
            if (holds()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    std::shared_ptr<FramedStream> stream;

private:
    struct Notes {
        std::mutex mutex;
        std::condition_variable changed;
        std::vector<Message> messages;
        std::string reason;
        int closes = 0;
        std::size_t sent = 0;

        template <typename Change>
        void add(Change const& change) {
            std::scoped_lock const lock(mutex);
            change();
            changed.notify_all();
        }
        template <typename Condition>
        bool wait(Condition const& condition) {
            std::unique_lock lock(mutex);
            return changed.wait_for(lock, std::chrono::seconds(30), condition);
        }
    };
    std::shared_ptr<Notes> notes_ = std::make_shared<Notes>();
};

inline Bytes framed(Bytes const& body) {
    Bytes bytes(4 + body.size());
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[i] = static_cast<std::byte>(body.size() >> (8 * i));
    }
    std::copy(body.begin(), body.end(), bytes.begin() + 4);
    return bytes;
}

/// Reads everything until the other side ends the connection.
inline Bytes read_to_end(Socket& socket) {
    Bytes all;
    Bytes part(65536);
    boost::system::error_code error;
    while (!error) {
        std::size_t const size = socket.read_some(boost::asio::buffer(part), error);
        all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return all;
}

/// Decodes these bytes as messages, each with its length in front.
inline std::vector<Message> messages_of(Bytes const& bytes) {
    std::vector<Message> messages;
    for (std::size_t at = 0; at + 4 <= bytes.size();) {
        std::size_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            size |= std::to_integer<std::size_t>(bytes[at + i]) << (8 * i);
        }
        at += 4;
        messages.push_back(decode_message(ByteView(bytes).subspan(at, size)));
        at += size;
    }
    return messages;
}

/// A batch message of about this many bytes.
inline EncodedBatch large_batch(std::uint64_t number, std::size_t bytes) {
    EncodedBatch batch;
    batch.number = number;
    batch.tiles = {make_tile(7, 1, 1)};
    batch.payload.assign(bytes, static_cast<std::byte>(number));
    return batch;
}

} // namespace framelet
