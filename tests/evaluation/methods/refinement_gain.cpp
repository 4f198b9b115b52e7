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

void RefinementGain::add_level(int level, Picture const& picture) {
    auto const index = static_cast<std::size_t>(level);
    if (level > 0 && details_[index - 1] > 0) {
        Picture coarser(picture.width, picture.height);
        upsample(pictures_[index - 1], 2, coarser);
        ratios_[index - 1] = mean_squared_error(coarser, picture) / details_[index - 1];
    }
    pictures_[index] = picture;
    details_[index] = detail_of(picture);
}

void RefinementGain::add_moved(Picture const& picture, double seconds) {
    if (!pictures_[0].rgba.empty() && seconds > 0) {
        drift_ = mean_squared_error(pictures_[0], picture) / seconds;
    }
    add_level(0, picture);
}

double RefinementGain::gain(int level) const {
    auto const index = static_cast<std::size_t>(level);
    return ratios_[index] * details_[index];
}

double RefinementGain::drift(double seconds) const {
    return std::isfinite(drift_) ? drift_ * std::abs(seconds) : drift_;
}

} // namespace framelet::bench
