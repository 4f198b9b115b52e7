// Limits a line of the log that others can make come however often: it is said so many times in a while, with how many
// were left out. In: the time. Out: what to put behind the line.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "server/session/limits/wall_time.h"

namespace framelet {

class LogLimit {
public:
    static constexpr std::chrono::seconds interval{10};

    /// `most`: lines in an interval.
    explicit LogLimit(std::size_t most = 1) : most_(most) {}

    /// Text to put behind the line; nothing where it is not to be said now.
    std::optional<std::string> next(WallTime now) {
        if (!began_ || now - *began_ >= interval) {
            began_ = now;
            said_ = 0;
        }
        if (said_ == most_) {
            ++left_out_;
            return std::nullopt;
        }
        ++said_;
        std::size_t const left_out = std::exchange(left_out_, 0);
        return left_out > 0 ? " (and " + std::to_string(left_out) + " more like it since the last line)" : "";
    }

private:
    std::size_t const most_;
    std::optional<WallTime> began_;
    std::size_t said_ = 0; ///< since then
    std::size_t left_out_ = 0;
};

} // namespace framelet
