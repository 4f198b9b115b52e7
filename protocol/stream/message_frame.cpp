#include "protocol/stream/message_frame.h"

#include <string>

#include "common/error.h"
#include "protocol/messages/message_codec.h"

namespace framelet {

Bytes frame_of(Message const& message) {
    constexpr std::size_t prefix_bytes = FramePrefix().size();
    Bytes bytes(prefix_bytes);
    append_message(message, bytes);
    std::size_t const size = bytes.size() - prefix_bytes;
    if (size > max_message_bytes) {
        throw UnsendableMessage("its " + std::to_string(size) + " bytes exceed the limit of " +
                                std::to_string(max_message_bytes));
    }
    for (std::size_t i = 0; i < prefix_bytes; ++i) {
        bytes[i] = static_cast<std::byte>(size >> (8 * i));
    }
    return bytes;
}

} // namespace framelet
