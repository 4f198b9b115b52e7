#include "tests/evaluation/methods/refinement_gain.h"

#include <cmath>

#include "tests/evaluation/measures/measures.h"
#include "tests/evaluation/methods/frame_grid.h"

namespace framelet::bench {
namespace {

/// Mean squared difference of neighbouring pixels.
double detail_of(Picture const& picture) {
    double sum = 0;
    for (int y = 1; y < picture.height; ++y) {
        std::uint8_t const* const above = picture.row(y - 1);
        std::uint8_t const* const row = picture.row(y);
        for (int x = 4; x < 4 * picture.width; ++x) {
            if (x % 4 != 3) {
                double const across = row[x] - row[x - 4];
                double const down = row[x] - above[x];
                sum += across * across + down * down;
            }
        }
    }
    return sum / (2 * 255.0 * 255 * 3 * picture.width * picture.height);
}

} // namespace

void RefinementGain::add(int frame, int level, Picture const& picture, double time) {
    Level& own = levels_[static_cast<std::size_t>(level)];
    if (level > 0) {
        Level& coarser = levels_[static_cast<std::size_t>(level - 1)];
        if (coarser.frame == frame && coarser.detail > 0) {
            Picture before(picture.width, picture.height);
            upsample(coarser.picture, 2, before);
            coarser.ratio = mean_squared_error(before, picture) / coarser.detail;
        }
    }
    if (own.frame != frame && time > own.time) {
        drift_ = mean_squared_error(own.picture, picture) / (time - own.time);
    }
    own.picture = picture;
    own.frame = frame;
    own.time = time;
    own.detail = detail_of(picture);
}

double RefinementGain::gain(int level) const {
    Level const& own = levels_[static_cast<std::size_t>(level)];
    return own.ratio * own.detail;
}

double RefinementGain::residual(int level) const {
    double sum = 0;
    for (int l = level; l < levels - 1; ++l) {
        sum += gain(l);
    }
    return sum;
}

void RefinementGain::forget_motion() {
    drift_ = INFINITY;
    for (Level& level : levels_) {
        level.time = NAN;
    }
}

double RefinementGain::drift(double seconds) const {
    return std::isfinite(drift_) ? drift_ * std::abs(seconds) : drift_;
}

} // namespace framelet::bench
