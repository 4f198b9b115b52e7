#include "tests/evaluation/measures/steadiness.h"

namespace framelet::bench {

double unsteadiness(std::array<Picture, 3> const& shown, std::array<Picture, 3> const& reference) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < shown[0].rgba.size(); ++i) {
        if (i % 4 == 3) {
            continue;
        }
        auto const error = [&](std::size_t k) {
            return static_cast<double>(shown[k].rgba[i]) - static_cast<double>(reference[k].rgba[i]);
        };
        double const second = (error(0) - 2 * error(1) + error(2)) / 255;
        sum += second * second;
        ++count;
    }
    return sum / static_cast<double>(count);
}

} // namespace framelet::bench
