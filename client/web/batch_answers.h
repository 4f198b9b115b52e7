// Answers batches when they arrive, in the page's thread that has the socket: the painter's, which decodes them, is
// busy for longer than a link's round trip. In: bytes of the socket, and when they came. Out: a frame with an Ack for
// each.
#pragma once

#include <cstdint>

#include "client/web/frame_inbox.h"

namespace framelet {

/// Of one connection. What is wrong with the bytes is the painter's to say: nothing more is answered then.
class BatchAnswers {
public:
    /// The answers to all batches that end in these bytes. `received_us` as in `Ack`.
    Bytes answer(ByteView bytes, std::uint64_t received_us);

private:
    FrameInbox inbox_;
    bool is_broken_ = false;
};

} // namespace framelet
