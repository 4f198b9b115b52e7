#include "tests/evaluation/measures/measures.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace framelet::bench {

double mean_squared_error(Picture const& shown, Picture const& reference) {
    FRAMELET_CHECK(shown.width == reference.width && shown.height == reference.height && !reference.rgba.empty());
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < shown.rgba.size(); ++i) {
        int const difference = i % 4 == 3 ? 0 : shown.rgba[i] - reference.rgba[i];
        sum += static_cast<std::uint64_t>(difference * difference);
    }
    return static_cast<double>(sum) / (255.0 * 255.0 * 3.0 * static_cast<double>(shown.rgba.size() / 4));
}

double psnr_from_mse(double mse) {
    return -10 * std::log10(std::max(mse, 1e-10));
}

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

Measures measure(Picture const& shown, Picture const& reference) {
    Measures measures;
    measures.mse = mean_squared_error(shown, reference);
    measures.psnr = psnr_from_mse(measures.mse);
    if (measures.mse > 0) {
        measures.ssim = structural_similarity(shown, reference);
        measures.flip = mean_flip(shown, reference);
    }
    return measures;
}

} // namespace framelet::bench
