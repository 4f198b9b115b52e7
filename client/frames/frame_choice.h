// Chooses which frames of a run are written to files: all, or some that follow given times of the scene, so that
// writing does not take the processor from what is shown. In: times. Out: yes or no, frame by frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace framelet {

class FrameChoice {
public:
    /// Frames in a row that are written from each time on: as many as tell how a picture changes, and how that changes.
    static constexpr int frames_at_once = 3;

    /// `times`: scene times, seconds; none: all frames are written.
    explicit FrameChoice(std::vector<double> times) : times_(std::move(times)) { std::ranges::sort(times_); }

    /// True where the next frame, which is to show the scene at `now`, seconds, is to be written. Time does not go
    /// back.
    bool takes(double now) {
        while (next_ < times_.size() && times_[next_] <= now) {
            left_ = left_ > 0 ? left_ : frames_at_once; // a row that has begun is finished first
            ++next_;
        }
        if (times_.empty()) {
            return true;
        }
        left_ = std::max(left_ - 1, -1);
        return left_ >= 0;
    }

private:
    std::vector<double> times_;
    std::size_t next_ = 0;
    int left_ = 0;
};

} // namespace framelet
