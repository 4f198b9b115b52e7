// The messages by which the viewer has told the server which framelets it has evicted, kept for as long as they might
// be lost with the connection. In: messages, how many of them the server has. Out: those to send again. A value.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "protocol/messages/message.h"

namespace framelet {

/// Messages that tell the server of all evicted framelets, each with `max_evicted` at most. Sorts `gone`.
inline std::vector<Evicted> evicted_messages(std::vector<SentTile>& gone) {
    std::ranges::sort(gone);
    std::vector<Evicted> messages;
    for (std::size_t first = 0; first < gone.size(); first += max_evicted) {
        std::size_t const count = std::min(max_evicted, gone.size() - first);
        auto const begin = gone.begin() + static_cast<std::ptrdiff_t>(first);
        messages.push_back({{begin, begin + static_cast<std::ptrdiff_t>(count)}});
    }
    return messages;
}

class ToldEvictions {
public:
    /// The largest number of framelets of messages that are kept; of more it is no longer known which the server has
    /// heard of.
    static constexpr std::size_t most_framelets = std::size_t{1} << 18;

    void keep(Evicted told) {
        if (is_lost_) {
            return;
        }
        framelets_ += told.framelets.size();
        messages_.push_back(std::move(told));
        if (framelets_ > most_framelets) {
            messages_.clear();
            is_lost_ = true;
        }
    }
    /// The server says that so many of all messages have come.
    void note_come(std::uint64_t messages) {
        for (; come_ < messages && !messages_.empty(); ++come_) {
            framelets_ -= messages_.front().framelets.size();
            messages_.pop_front();
        }
    }

    /// The messages that may not have come, in order.
    std::deque<Evicted> const& messages() const { return messages_; }
    /// True where there were too many: no session can go on with what is held.
    bool is_lost() const { return is_lost_; }

private:
    std::deque<Evicted> messages_;
    std::size_t framelets_ = 0; ///< in `messages_`
    std::uint64_t come_ = 0; ///< messages that the server has
    bool is_lost_ = false;
};

} // namespace framelet
