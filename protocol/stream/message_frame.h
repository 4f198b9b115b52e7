// Frames: messages as they go over a connection, each with its length in front, in four bytes, the lowest first. In:
// messages. Out: frames, and how long what follows a prefix is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/messages/message.h"

namespace framelet {

using FramePrefix = std::array<std::uint8_t, 4>;

/// Encodes a message with its prefix. Throws UnsendableMessage where it is out of range, or longer than
/// `max_message_bytes`.
Bytes frame_of(Message const& message);

/// Size of the body that follows a prefix, bytes, unchecked.
inline std::size_t body_size(FramePrefix const& prefix) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < prefix.size(); ++i) {
        size |= std::size_t{prefix[i]} << (8 * i);
    }
    return size;
}

} // namespace framelet
