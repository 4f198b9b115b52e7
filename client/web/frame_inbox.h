// Finds the frames in a stream of bytes that is cut anywhere. In: bytes as they come. Out: bodies of whole frames. A
// value.
#pragma once

#include <optional>

#include "protocol/messages/message.h"

namespace framelet {

class FrameInbox {
public:
    void add(ByteView bytes);
    /// The body of the next frame that is whole, valid until the next call; nothing where there is none. Throws
    /// ProtocolError where one is too long.
    std::optional<ByteView> next();
    /// The server has answered: from now on frames may be as long as batches are.
    void take_large() { most_bytes_ = max_message_bytes; }

private:
    Bytes bytes_;
    std::size_t begin_ = 0; ///< of the first frame that has not been given out
    std::size_t most_bytes_ = max_upstream_message_bytes; ///< of a body
};

} // namespace framelet
