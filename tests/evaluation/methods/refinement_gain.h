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

    /// Level 0 is the coarsest. `picture` has one pixel a sample; `time`: when its frame is to be seen, seconds.
    void add(int frame, int level, Picture const& picture, double time);

    /// What the level after this one brings: from how much neighbouring samples of it differ, and from what that meant
    /// for the frames of which both levels are known.
    double gain(int level) const;
    /// What it costs that a picture is so many seconds off; without motion so far, infinite: it has only begun.
    double drift(double seconds) const;
    /// What all levels after this one would bring: how far off it is where nothing has moved.
    double residual(int level) const;
    /// Nothing moves: what moves next may be something else.
    void forget_motion();

private:
    struct Level {
        Picture picture;
        int frame = -1;
        double time = NAN; ///< NaN: from before what moves now began to
        double detail = 0;
        double ratio = 0.5; ///< of gain to detail
    };
    std::array<Level, levels> levels_;
    double drift_ = INFINITY; ///< a second
};

} // namespace framelet::bench
