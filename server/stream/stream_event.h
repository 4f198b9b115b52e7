// The events of one viewer's stream, as values: what the viewer says, what the socket did. In the order in which they
// came they are all that a stream knows of the world, beside its turns.
#pragma once

#include <cstdint>
#include <variant>

#include "protocol/messages/message.h"

namespace framelet {

/// The scene's clock was set: what is to be seen may be another moment.
struct ClockChanged {
    bool operator==(ClockChanged const&) const = default;
};

/// A batch was handed to the socket.
struct BatchSent {
    std::uint64_t batch = 0;
    std::uint64_t bytes = 0; ///< on the wire
    bool operator==(BatchSent const&) const = default;
};

/// The viewer is back after its connection was cut. It has all batches up to this one, and is sent the later ones once
/// more. What it looks at follows.
struct Resumed {
    std::uint64_t last_batch = 0;
    bool operator==(Resumed const&) const = default;
};

struct StreamEvent {
    double seconds = 0; ///< when, on the server's steady clock
    std::variant<CameraUpdate, ViewerSettings, Ack, Evicted, ClockChanged, BatchSent, Resumed> what;
    bool operator==(StreamEvent const&) const = default;
};

} // namespace framelet
