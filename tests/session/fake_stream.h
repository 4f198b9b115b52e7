// A connection without a socket. For tests only.
#pragma once

#include "protocol/stream/framed_stream.h"

namespace framelet {

/// The test says what comes.
class FakeStream : public FramedStream {
public:
    void start(Handlers handlers, std::size_t) override { handlers_ = std::move(handlers); }
    void set_max_body(std::size_t) override {}
    std::size_t send(Message const&) override { return 0; }
    std::size_t unsent_bytes() const override { return 0; }
    void close_after_sending() override {}
    void close() override { is_closed = true; }
    std::string peer() const override { return "nobody"; }

    void bring(Message const& message) { handlers_.on_message(message); }
    /// What the callbacks hold is released, as when a connection has ended.
    void forget_handlers() { handlers_ = {}; }

    bool is_closed = false;

private:
    Handlers handlers_;
};

} // namespace framelet
