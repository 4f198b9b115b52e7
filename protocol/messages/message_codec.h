// Messages to bytes and back, as PROTOCOL.md says.
#pragma once

#include "protocol/messages/message.h"

namespace framelet {

/// Body of one message (without the length prefix). Every number must be inside its range (FRAMELET_CHECK); text is
/// made one line of UTF-8 and cut to its limit, the last cameras of a Welcome that exceeds max_upstream_message_bytes
/// are left out.
Bytes encode_message(Message const& message);
/// The same, appended to `out`.
void append_message(Message const& message, Bytes& out);

/// Throws ProtocolError for anything that is not a well-formed message with every field inside its stated range.
Message decode_message(ByteView body);

} // namespace framelet
