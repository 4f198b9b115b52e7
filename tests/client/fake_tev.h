// Listens as the image viewer tev does, reads packets as its src/Ipc.cpp and include/tev/Ipc.h say, and keeps what the
// image is then.
#pragma once

#include <cstdint>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <sys/socket.h>

namespace framelet::test {

struct TevImage {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::string> channels;
    int updates = 0;
    std::vector<float> values; ///< interleaved
    std::string complaint; ///< about a packet that tev would not take
};

/// A tev that takes one connection.
class FakeTev {
public:
    FakeTev() : acceptor_(io_, {boost::asio::ip::address_v4::loopback(), 0}), socket_(io_) {
        thread_ = std::thread([this] { run(); });
    }
    ~FakeTev() {
        end();
        thread_.join();
    }
    FakeTev(FakeTev const&) = delete;
    FakeTev& operator=(FakeTev const&) = delete;

    std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
    std::string address() const { return "127.0.0.1:" + std::to_string(port()); }
    TevImage image() const {
        std::lock_guard const lock(mutex_);
        return image_;
    }
    /// Ends as when its user closes it.
    void end() {
        std::lock_guard const lock(mutex_);
        ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
        if (socket_.is_open()) {
            ::shutdown(socket_.native_handle(), SHUT_RDWR);
        }
    }

private:
    /// A packet that is read field by field; throws std::out_of_range where it is too short.
    class Packet {
    public:
        explicit Packet(std::string bytes) : bytes_(std::move(bytes)) {}

        template <class Number>
        Number number() {
            Number out;
            std::memcpy(&out, bytes_.substr(at_).data(), sizeof(out));
            skip(sizeof(out));
            return out;
        }
        std::string text() {
            std::string const out = bytes_.substr(at_, bytes_.find('\0', at_) - at_);
            skip(out.size() + 1);
            return out;
        }
        void skip(std::size_t count) {
            at_ += count;
            if (at_ > bytes_.size()) {
                throw std::out_of_range("the packet is too short");
            }
        }
        std::string_view rest() const { return std::string_view(bytes_).substr(at_); }

    private:
        std::string bytes_;
        std::size_t at_ = 0;
    };

    void run() {
        boost::system::error_code error;
        boost::asio::ip::tcp::socket accepted(io_);
        acceptor_.accept(accepted, error);
        if (error) {
            return;
        }
        {
            std::lock_guard const lock(mutex_);
            socket_ = std::move(accepted);
        }
        for (;;) {
            std::uint32_t length = 0;
            boost::asio::read(socket_, boost::asio::buffer(&length, sizeof(length)), error);
            std::string bytes(error ? 0 : length - sizeof(length), '\0');
            if (error || boost::asio::read(socket_, boost::asio::buffer(bytes), error) != bytes.size()) {
                return;
            }
            std::lock_guard const lock(mutex_);
            try {
                take(Packet(std::move(bytes)));
            } catch (std::exception const& exception) {
                image_.complaint = exception.what();
            }
        }
    }

    void take(Packet packet) {
        int const kind = packet.number<char>();
        packet.number<char>(); // whether it comes to the front
        std::string const name = packet.text();
        if (kind == 4) {
            image_.name = name;
            image_.width = packet.number<std::int32_t>();
            image_.height = packet.number<std::int32_t>();
            image_.channels.resize(static_cast<std::size_t>(packet.number<std::int32_t>()));
            for (std::string& channel : image_.channels) {
                channel = packet.text();
            }
            return;
        }
        if (kind != 6 || name != image_.name) {
            throw std::runtime_error("kind " + std::to_string(kind) + " for " + name);
        }
        auto const count = static_cast<std::size_t>(packet.number<std::int32_t>());
        for (std::size_t i = 0; i < count; ++i) {
            packet.text();
        }
        for (int const expected : {0, 0, image_.width, image_.height}) {
            if (packet.number<std::int32_t>() != expected) {
                throw std::runtime_error("not all of the image");
            }
        }
        std::vector<std::int64_t> offsets(count), strides(count);
        for (auto* const values : {&offsets, &strides}) {
            for (std::int64_t& value : *values) {
                value = packet.number<std::int64_t>();
            }
        }
        std::size_t const pixels = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
        std::vector<float> values(packet.rest().size() / sizeof(float));
        std::memcpy(values.data(), packet.rest().data(), values.size() * sizeof(float));
        image_.values.assign(pixels * count, 0);
        for (std::size_t i = 0; i < pixels * count; ++i) {
            auto const channel = i % count;
            image_.values[i] = values.at(static_cast<std::size_t>(offsets[channel]) +
                                         i / count * static_cast<std::size_t>(strides[channel]));
        }
        ++image_.updates;
    }

    boost::asio::io_context io_;
    boost::asio::ip::tcp::acceptor acceptor_;
    mutable std::mutex mutex_; // guards what follows
    boost::asio::ip::tcp::socket socket_;
    TevImage image_;
    std::thread thread_;
};

} // namespace framelet::test
