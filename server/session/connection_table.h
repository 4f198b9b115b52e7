// All connections: viewers, and those that have not said yet who they are. In: sessions as they begin and end. Out:
// which are open, and which ought to be ended.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/steady_timer.hpp>

#include "server/session/session.h"

namespace framelet {

struct Connection {
    std::shared_ptr<Session> session;
    std::shared_ptr<FramedStream> stream;
    std::string source; ///< as `source_of` has it
    std::string peer; ///< where it comes from, for the log
    std::unique_ptr<boost::asio::steady_timer> start; ///< of a delayed start; null: it starts at once
    bool admitted = false; ///< its viewer was let in
    bool was_ended = false; ///< its session had ended at the last heartbeat, and it is here all the same
};

/// May be used on the io thread only, but for `open_sessions`, which may be called from any.
class ConnectionTable {
public:
    void add(std::uint64_t id, Connection connection);
    /// The connection of this number, valid until it goes; null: it has gone.
    Connection* find(std::uint64_t id);
    void erase(std::uint64_t id);
    std::map<std::uint64_t, Connection> const& all() const { return connections_; }

    /// Sessions of viewers that were let in and have not left.
    std::vector<std::shared_ptr<Session>> open_sessions() const;
    /// Sessions of those who have no pictures, likewise: workers, and servers that follow the clock.
    std::vector<std::shared_ptr<Session>> other_sessions() const;
    /// Sessions from which something has been waited for too long, and what.
    std::vector<std::pair<std::shared_ptr<Session>, std::string>>
    overdue(std::chrono::steady_clock::time_point now) const;
    /// Sessions whose socket waits for nothing any more, for want of memory.
    std::vector<std::shared_ptr<Session>> stuck() const;
    /// Numbers of connections whose session had ended at the last call already: there was no memory for all that
    /// belongs to an end.
    std::vector<std::uint64_t> take_remains();

private:
    std::vector<std::shared_ptr<Session>> open_sessions(bool has_pictures) const;

    mutable std::mutex mutex_;
    std::map<std::uint64_t, Connection> connections_; ///< changed on the io thread only
};

} // namespace framelet
