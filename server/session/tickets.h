// Keeps whose ticket is whose: viewers that are here, and those whose connection was cut and who may come back. In:
// tickets, sessions, times. Out: who has to be given up.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "server/session/session.h"

namespace framelet {

class Tickets {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// Longest time that a viewer may be away.
    static constexpr std::chrono::seconds most_time{60};

    struct Holder {
        Ticket ticket{};
        std::shared_ptr<Session> session; ///< the newest of this viewer
        std::uint64_t seat = 0; ///< the number of its first session
        std::uint32_t codings = 0;
        bool knows_control_token = false;
        std::optional<Time> parked; ///< since when it is away; nothing: it is here
    };

    void issue(Holder holder) { holders_.push_back(std::move(holder)); }
    /// The holder of a ticket; null: nobody. Valid until the next holder comes or goes, as all that is returned here.
    Holder* find(Ticket const& ticket) { return found(std::ranges::find(holders_, ticket, &Holder::ticket)); }
    Holder* of(Session const& session) {
        return found(std::ranges::find(holders_, &session, [](Holder const& holder) { return holder.session.get(); }));
    }
    /// One of the holders; null: there is none.
    Holder* any() { return holders_.empty() ? nullptr : &holders_.back(); }
    /// The holder that has been away longest; null: none is away.
    Holder* longest_parked() {
        auto const least = std::ranges::min_element(
            holders_, {}, [](Holder const& holder) { return holder.parked.value_or(Time::max()); });
        return least != holders_.end() && least->parked ? &*least : nullptr;
    }
    /// The holder that has been away longest, if that is too long; else null.
    Holder* overdue(Time now) {
        Holder* const holder = longest_parked();
        return holder != nullptr && now - *holder->parked > most_time ? holder : nullptr;
    }
    std::size_t parked_count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(holders_, [](Holder const& holder) { return holder.parked.has_value(); }));
    }
    void erase(Holder const* holder) { holders_.erase(holders_.begin() + (holder - holders_.data())); }

private:
    Holder* found(std::vector<Holder>::iterator place) { return place == holders_.end() ? nullptr : &*place; }

    std::vector<Holder> holders_; ///< few
};

} // namespace framelet
