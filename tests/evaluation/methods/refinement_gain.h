// Judges whether the next, finer level of a frame is worth its time while the scene moves on. In: pictures of the
// levels, and how long they took. Out: what the next level brings, what waiting for it costs, both as mean squared
// error.
#pragma once

#include <array>
#include <cmath>

#include "common/image.h"

namespace framelet::bench {

class RefinementGain {
public:
    static constexpr int levels = 3;

    /// Notes the picture of a level; level 0 is the coarsest. `picture` has one pixel a sample; `time`: when its frame
    /// is to be seen, seconds; NaN: nothing moves.
    void add(int frame, int level, Picture const& picture, double time);

    /// Error that the level after this one takes away, estimated from how much neighbouring samples of this one differ,
    /// and from what that meant for frames of which both levels are known.
    double gain(int level) const;
    /// Error of a picture that is so many seconds off; infinite as long as no motion was measured: it has only begun.
    double drift(double seconds) const;
    /// Error that all levels after this one would take away: how far off the picture is where nothing has moved.
    double residual(int level) const;
    /// Forgets the measured motion when nothing moves, since something else may move next.
    void forget_motion();

private:
    struct Level {
        Picture picture;
        int frame = -1;
        double time = NAN; ///< time of its frame, seconds; NaN: from before the present motion began
        double detail = 0;
        double ratio = 0.5; ///< ratio of gain to detail
    };
    std::array<Level, levels> levels_;
    double drift_ = INFINITY; ///< error that a second of motion adds
};

} // namespace framelet::bench
