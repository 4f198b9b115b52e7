#include "server/session/connection_table.h"

namespace framelet {

void ConnectionTable::add(std::uint64_t id, Connection connection) {
    std::scoped_lock const lock(mutex_);
    connections_[id] = std::move(connection);
}

Connection* ConnectionTable::find(std::uint64_t id) {
    auto const found = connections_.find(id);
    return found == connections_.end() ? nullptr : &found->second;
}

void ConnectionTable::erase(std::uint64_t id) {
    std::scoped_lock const lock(mutex_);
    connections_.erase(id);
}

std::vector<std::shared_ptr<Session>> ConnectionTable::open_sessions() const {
    return open_sessions(true);
}

std::vector<std::shared_ptr<Session>> ConnectionTable::other_sessions() const {
    return open_sessions(false);
}

std::vector<std::shared_ptr<Session>> ConnectionTable::open_sessions(bool has_pictures) const {
    std::scoped_lock const lock(mutex_);
    std::vector<std::shared_ptr<Session>> open;
    for (auto const& [id, connection] : connections_) {
        if (connection.session->is_open() && connection.session->has_pictures() == has_pictures) {
            open.push_back(connection.session);
        }
    }
    return open;
}

std::vector<std::pair<std::shared_ptr<Session>, std::string>>
ConnectionTable::overdue(std::chrono::steady_clock::time_point now) const {
    std::vector<std::pair<std::shared_ptr<Session>, std::string>> found;
    for (auto const& [id, connection] : connections_) {
        if (auto const reason = connection.session->overdue(now)) {
            found.emplace_back(connection.session, *reason);
        }
    }
    return found;
}

std::vector<std::shared_ptr<Session>> ConnectionTable::stuck() const {
    std::vector<std::shared_ptr<Session>> found;
    for (auto const& [id, connection] : connections_) {
        if (connection.session->is_stuck()) {
            found.push_back(connection.session);
        }
    }
    return found;
}

std::vector<std::uint64_t> ConnectionTable::take_remains() {
    std::vector<std::uint64_t> remains;
    for (auto& [id, connection] : connections_) {
        if (connection.was_ended) {
            remains.push_back(id);
        }
        connection.was_ended = connection.session->has_ended();
    }
    return remains;
}

} // namespace framelet
