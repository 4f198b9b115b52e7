// Decides when pictures are begun and shown, so that each is of the moment at which it is seen. In: the display's rate,
// how long a picture takes, when one was shown. Out: points in time.
#pragma once

#include <algorithm>
#include <chrono>

namespace framelet {

class DisplayTiming {
public:
    using Clock = std::chrono::steady_clock;

    /// The first picture is due at `start`. `rate` > 0: pictures a second.
    DisplayTiming(Clock::time_point start, double rate) : period_(duration(1 / rate)), due_(start) {}

    static Clock::duration duration(double seconds) {
        return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }

    /// The time to begin the next picture, which takes `making_seconds`.
    Clock::time_point begin(double making_seconds) const { return due_ - duration(making_seconds); }
    /// The time to show a picture that is begun now: when it is due, or as soon as it is ready.
    Clock::time_point show(Clock::time_point now, double making_seconds) const {
        return std::max(due_, now + duration(making_seconds));
    }
    /// Notes that a picture was shown. True where the next one is more than a display frame late now; it is due at once
    /// then.
    bool note_shown(Clock::time_point now) {
        due_ += period_;
        bool const late = now > due_ + period_;
        due_ = late ? now : due_;
        return late;
    }

private:
    Clock::duration period_;
    Clock::time_point due_;
};

} // namespace framelet
