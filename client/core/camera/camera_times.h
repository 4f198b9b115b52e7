// The times at which the viewer's cameras were set and sent. In: their numbers, which count up, and times. Out: how
// long ago that was. A value.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace framelet {

class CameraTimes {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// The largest number of cameras that are remembered; of more the oldest are forgotten.
    static constexpr std::size_t most_cameras = 256;

    void note_set(std::uint64_t number, Time time) { note(number, time, set_); }
    void note_sent(std::uint64_t number, Time time) { note(number, time, sent_); }
    void forget_sent() { sent_.clear(); }

    /// Seconds since this camera was set or sent; nothing where that has been asked already, of it or a newer one.
    std::optional<double> since_set(std::uint64_t number, Time now) { return since(number, now, set_); }
    std::optional<double> since_sent(std::uint64_t number, Time now) { return since(number, now, sent_); }

private:
    struct Noted {
        std::uint64_t number;
        Time time;
    };

    static void note(std::uint64_t number, Time time, std::deque<Noted>& cameras) {
        cameras.push_back({number, time});
        if (cameras.size() > most_cameras) {
            cameras.pop_front();
        }
    }
    static std::optional<double> since(std::uint64_t number, Time now, std::deque<Noted>& cameras) {
        std::optional<double> seconds;
        while (!cameras.empty() && cameras.front().number <= number) {
            if (cameras.front().number == number) {
                seconds = std::chrono::duration<double>(now - cameras.front().time).count();
            }
            cameras.pop_front();
        }
        return seconds;
    }

    std::deque<Noted> set_; ///< cameras set and not shown yet, the oldest first
    std::deque<Noted> sent_; ///< cameras sent in this session of which no batch has come, the oldest first
};

} // namespace framelet
