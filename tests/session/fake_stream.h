// A connection without a socket. For tests only.
#pragma once

#include <memory>

#include "protocol/stream/framed_stream.h"

namespace framelet {

/// A stream of which the test says what comes.
class FakeStream : public FramedStream {
public:
    void start(Handlers handlers, std::size_t) override { handlers_ = std::move(handlers); }
    void set_max_body(std::size_t) override {}
    std::size_t send(Message const&) override {
        ++sent;
        return 0;
    }
    std::size_t unsent_bytes() const override { return 0; }
    void close_after_sending() override {}
    void close() override { is_closed = true; }
    std::string peer() const override { return "nobody"; }

    bool was_cut() const override { return was_cut_; }
    bool asks_for_files() const override { return is_browser; }

    void bring(Message const& message) { handlers_.on_message(message); }
    /// Ends the connection from the other side; `cut`: without a word.
    void lose(std::string const& reason, bool cut) {
        was_cut_ = cut;
        handlers_.on_close(reason);
    }
    /// Releases what the callbacks hold, as when a connection has ended.
    void forget_handlers() { handlers_ = {}; }

    bool is_closed = false, is_browser = false;
    int sent = 0; ///< messages

private:
    Handlers handlers_;
    bool was_cut_ = false;
};

/// A connection of a test, which ends with this object: a session and the callbacks of its connection hold each other
/// until the connection ends.
class FakeConnection {
public:
    FakeConnection() = default;
    ~FakeConnection() { stream_->forget_handlers(); }
    FakeConnection(FakeConnection const&) = delete;
    FakeConnection& operator=(FakeConnection const&) = delete;

    FakeStream* operator->() const { return stream_.get(); }
    std::shared_ptr<FakeStream> const& stream() const { return stream_; }

private:
    std::shared_ptr<FakeStream> const stream_ = std::make_shared<FakeStream>();
};

} // namespace framelet
