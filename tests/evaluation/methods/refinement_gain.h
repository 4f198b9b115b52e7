// Whether the next, finer level of a frame is worth its time while the scene moves on. In: pictures of the levels, and
// how long they took. Out: what the next level brings, what waiting for it costs, both as mean squared error.
#pragma once

#include <array>
#include <cmath>

#include "common/image.h"

namespace framelet::bench {

class RefinementGain {
public:
    static constexpr int levels = 3;

    /// Level 0 is the coarsest. `picture` has one pixel a sample.
    void add_level(int level, Picture const& picture);
    /// The same of a new frame's level 0, which shows things as they are `seconds` after the last frame.
    void add_moved(Picture const& picture, double seconds);

    /// What the level after this one brings: from how much neighbouring samples of it differ, and from what that meant
    /// for the frames of which both levels are known.
    double gain(int level) const;
    /// What it costs that a picture is so many seconds off; without motion so far, infinite: it has only begun.
    double drift(double seconds) const;
    /// Nothing moves: what moves next may be something else.
    void forget_motion() { drift_ = INFINITY; }

private:
    std::array<Picture, levels> pictures_;
    std::array<double, levels> details_{};
    std::array<double, levels> ratios_{0.5, 0.5, 0.5}; ///< of gain to detail
    double drift_ = INFINITY; ///< a second
};

} // namespace framelet::bench
