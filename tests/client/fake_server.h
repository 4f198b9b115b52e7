// A server for tests of the viewer: in this process, on a free port of the loopback interface, sends what it is told
// to.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include "protocol/codec/batch_codec.h"
#include "protocol/connection/server_address.h"
#include "protocol/stream/stream_opening.h"

namespace framelet::test {

class FakeServer {
public:
    using Tcp = boost::asio::ip::tcp;

    static Welcome plain_welcome() {
        Welcome out;
        out.server = "fake";
        out.scene_name = "fake scene";
        out.scene_identity = 7;
        return out;
    }

    struct Script {
        Welcome welcome = plain_welcome();
        /// The text of the Failure that is answered instead of Welcome, if not empty.
        std::string refusal;
        bool refusal_again = false; ///< as in Failure
        /// Bytes that are sent as they are instead of anything else, if not empty.
        std::string raw_bytes;
        /// The server neither answers nor closes.
        bool mute = false;
        /// The content of heartbeats, but for what the server knows better.
        Status status;
        /// Seconds between heartbeats; 0: there are none.
        double heartbeat_seconds = 0.2;
    };

    FakeServer() : FakeServer(Script{}) {}
    explicit FakeServer(Script script) : script_(std::move(script)) {
        accept();
        thread_ = std::thread([this] { io_.run(); });
    }
    ~FakeServer() {
        io_.stop();
        thread_.join();
    }

    ServerAddress address() const { return {"127.0.0.1", port_}; }

    /// Sends a batch to every viewer, all of which have got the same batches before; numbers the batch if it has no
    /// number.
    void send(Batch batch) {
        boost::asio::post(io_, [this, batch = std::move(batch)]() mutable {
            batch.number = batch.number == 0 ? ++last_batch_ : batch.number;
            EncodedBatch const encoded = codec_.encode(batch, &memory_);
            for (auto const& stream : streams_) {
                stream->send(encoded);
            }
        });
    }
    void send(Message message) {
        boost::asio::post(io_, [this, message = std::move(message)] {
            for (auto const& stream : streams_) {
                stream->send(message);
            }
        });
    }
    /// Cuts every connection.
    void vanish() {
        boost::asio::post(io_, [this] {
            boost::system::error_code ignored;
            acceptor_.close(ignored);
            for (auto const& stream : streams_) {
                stream->close();
            }
            streams_.clear();
            greeted_.clear();
            raw_sockets_.clear();
        });
    }
    /// Cuts every connection, and answers the next as this says, as a server does that is started anew.
    void start_anew(Script script) {
        boost::asio::post(io_, [this, script = std::move(script)] {
            script_ = script;
            last_batch_ = 0;
            memory_ = {};
            for (auto const& stream : streams_) {
                stream->close();
            }
            streams_.clear();
            greeted_.clear();
        });
    }
    /// Cuts every connection, and answers the next as this says, as a server does to which a viewer comes back.
    void cut(Script script) {
        boost::asio::post(io_, [this, script = std::move(script)] {
            script_ = script;
            for (auto const& stream : streams_) {
                stream->close();
            }
            streams_.clear();
            greeted_.clear();
        });
    }
    /// Keeps the connections but says nothing any more.
    void fall_silent() {
        boost::asio::post(io_, [this] { script_.heartbeat_seconds = 0; });
    }

    /// Called on the server's thread for each message from a viewer. Set it before a viewer connects.
    std::function<void(Message const&)> on_message;

    /// Waits until `wanted` accepts what has been received so far.
    bool wait_for(std::function<bool(std::vector<Message> const&)> const& wanted,
                  std::chrono::seconds at_most = std::chrono::seconds(60)) {
        std::unique_lock lock(mutex_);
        return arrived_.wait_for(lock, at_most, [&] { return wanted(received_); });
    }
    template <typename T>
    bool wait_for_some(std::size_t count = 1) {
        return wait_for([count](std::vector<Message> const& messages) {
            std::size_t found = 0;
            for (Message const& message : messages) {
                found += std::holds_alternative<T>(message) ? 1 : 0;
            }
            return found >= count;
        });
    }
    template <typename T>
    std::vector<T> received() {
        std::lock_guard const lock(mutex_);
        std::vector<T> out;
        for (Message const& message : received_) {
            if (auto const* found = std::get_if<T>(&message)) {
                out.push_back(*found);
            }
        }
        return out;
    }

private:
    void accept() {
        acceptor_.async_accept([this](boost::system::error_code error, Tcp::socket socket) {
            if (error) {
                return;
            }
            if (!script_.raw_bytes.empty() || script_.mute) {
                raw_sockets_.push_back(std::make_shared<Tcp::socket>(std::move(socket)));
                boost::system::error_code ignored;
                boost::asio::write(*raw_sockets_.back(), boost::asio::buffer(script_.raw_bytes), ignored);
            } else {
                serve(std::move(socket));
            }
            accept();
        });
    }

    void serve(Tcp::socket socket) {
        auto stream = plain_stream(std::move(socket));
        streams_.push_back(stream);
        FramedStream::Handlers handlers;
        handlers.on_message = [this, weak = std::weak_ptr(stream)](Message message) {
            if (auto const shared = weak.lock()) {
                receive(*shared, message);
            }
        };
        handlers.on_close = [](std::string const&) {};
        stream->start(std::move(handlers), max_upstream_message_bytes);
    }

    void receive(FramedStream& stream, Message const& message) {
        if (std::holds_alternative<Hello>(message)) {
            if (!script_.refusal.empty()) {
                stream.send(Failure{script_.refusal, script_.refusal_again});
                stream.close_after_sending();
            } else {
                stream.send(script_.welcome);
                greeted_.insert(&stream);
                beat();
            }
        }
        {
            std::lock_guard const lock(mutex_);
            received_.push_back(message);
            if (auto const* camera = std::get_if<CameraUpdate>(&message)) {
                camera_number_ = camera->view.number;
            }
        }
        arrived_.notify_all();
        if (on_message) {
            on_message(message);
        }
    }

    void beat() {
        if (script_.heartbeat_seconds <= 0) {
            return;
        }
        Status status = script_.status;
        {
            std::lock_guard const lock(mutex_);
            status.camera_number = camera_number_;
        }
        status.last_batch = last_batch_;
        for (auto const& stream : streams_) {
            if (greeted_.contains(stream.get())) {
                stream->send(status);
            }
        }
        heart_.expires_after(std::chrono::milliseconds(static_cast<int>(1000 * script_.heartbeat_seconds)));
        heart_.async_wait([this](boost::system::error_code error) {
            if (!error) {
                beat();
            }
        });
    }

    Script script_;
    boost::asio::io_context io_;
    Tcp::acceptor acceptor_{io_, Tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
    std::uint16_t const port_ = acceptor_.local_endpoint().port();
    boost::asio::steady_timer heart_{io_};
    std::vector<std::shared_ptr<FramedStream>> streams_;
    std::set<FramedStream const*> greeted_; ///< those that have got Welcome, and hear heartbeats
    std::vector<std::shared_ptr<Tcp::socket>> raw_sockets_;
    BatchCodec codec_;
    BatchMemory memory_;
    std::uint64_t last_batch_ = 0;
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::vector<Message> received_;
    std::uint64_t camera_number_ = 0;
    std::thread thread_;
};

} // namespace framelet::test
