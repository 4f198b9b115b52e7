// Decides what is shown while the window changes its size. In: sizes, how much of the new picture is known, time. Out:
// which size to ask for, and whether the picture of before, stretched, is still better than the new one.
#pragma once

#include "common/camera.h"

namespace framelet {

/// A new size is asked for once the window has rested at it for a moment: what is rendered for the many sizes of a
/// window that is being dragged would never be seen.
class SteadySize {
public:
    explicit SteadySize(Viewport size) : steady_(size), newest_(size) {}

    Viewport update(Viewport size, double now_seconds) {
        if (size != newest_) {
            newest_ = size;
            since_ = now_seconds;
        }
        if (now_seconds - since_ >= rest_seconds) {
            steady_ = newest_;
        }
        return steady_;
    }
    /// True while the size to ask for will still change without the window's changing.
    bool waits() const { return steady_ != newest_; }

    static constexpr double rest_seconds = 0.1;

private:
    Viewport steady_;
    Viewport newest_;
    double since_ = 0;
};

/// Decides how long the picture of the old size is shown: the first picture of a new size has holes, which are grey.
class OldPicture {
public:
    /// True while the old picture is to be shown on, for `most_seconds` at most. `covered`: share of the new picture
    /// that is known.
    bool is_better(bool has_other_size, double covered, double now_seconds) {
        if (!has_other_size) {
            since_ = -1;
            return false;
        }
        since_ = since_ < 0 ? now_seconds : since_;
        if (covered >= enough) {
            return false;
        }
        return now_seconds - since_ < most_seconds;
    }

    static constexpr double most_seconds = 1;
    static constexpr double enough = 0.995;

private:
    double since_ = -1; ///< when the first of the new size came; < 0: none has
};

} // namespace framelet
