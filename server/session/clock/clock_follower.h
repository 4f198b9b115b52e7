// Hears the scene's clock of another server, so that several servers of a scene show the same moment. A resource with
// threads of its own. In: where that server is. Out: its clock, whenever it says how that stands.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "common/clock_state.h"
#include "protocol/connection/server_address.h"
#include "protocol/messages/message.h"

namespace framelet {

class ClockFollower {
public:
    /// How the other clock stands, and whether it may be set from here; nothing: it is not heard any more. Called on a
    /// thread of this object.
    using Take = std::function<void(std::optional<ClockState> const&, bool takes_requests)>;

    /// Connects, and again whenever that fails or the connection is lost, whatever the reason.
    ClockFollower(ConnectionOptions const& leader, Take take);
    /// Waits for an attempt to connect that is on its way, some seconds at most, but for the name's lookup.
    ~ClockFollower();

    /// Asks for the other clock to be set; does nothing while it is not heard. May be called from any thread.
    void request(ClockRequest const& request);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
