// Encodes messages to bytes and decodes them, as PROTOCOL.md says.
#pragma once

#include "protocol/messages/message.h"

namespace framelet {

/// Encodes the body of one message (without the length prefix). Throws UnsendableMessage where a number is out of its
/// range. Text is made one line of UTF-8 and cut to its limit; of a Welcome that would exceed
/// `max_upstream_message_bytes` the last cameras are left out.
Bytes encode_message(Message const& message);
/// Appends the same to `out`.
void append_message(Message const& message, Bytes& out);

/// Decodes the body of one message. Throws ProtocolError for anything that is not a well-formed message with every
/// field inside its stated range.
Message decode_message(ByteView body);

} // namespace framelet
