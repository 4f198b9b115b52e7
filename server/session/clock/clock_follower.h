// Hears the scene's clock of another server, so that several servers of a scene show the same moment. A resource with
// threads of its own. In: where that server is. Out: its clock, whenever it says how that stands.
#pragma once

#include <functional>
#include <memory>

#include "common/clock_state.h"
#include "protocol/connection/server_address.h"
#include "protocol/messages/message.h"

namespace framelet {

class ClockFollower {
public:
    /// How the other clock stands, and whether this server may set it. Called on a thread of this object.
    using Take = std::function<void(ClockState const&, bool controls)>;

    /// Connects, and comes back whenever the connection is lost. Before that and meanwhile nothing is heard.
    ClockFollower(ConnectionOptions const& leader, Take take);
    ~ClockFollower();

    /// Asks for the other clock to be set; does nothing while it is not heard. May be called from any thread.
    void request(ClockRequest const& request);

    /// A clock that is off by less, in seconds, is left as it is: what is said takes as long on its way now and then.
    static constexpr double exact_enough = 0.008;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
