// A connection that a measurement makes for as long as it takes. In: a port, and what to do with each message.
#pragma once

#include <cstdint>
#include <functional>

#include "protocol/framed_stream.h"
#include "protocol/message.h"

namespace framelet::bench {

/// Connects to 127.0.0.1:port, says hello and hands over each message, the Welcome first, until `receive` returns true:
/// it has what it wanted. Throws ConnectionError where the server ends the connection before.
void visit(std::uint16_t port, std::uint32_t codings,
           std::function<bool(FramedStream& stream, Message const& message)> const& receive);

} // namespace framelet::bench
