#include "tests/evaluation/light_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "server/render/light/luminance.h"
#include "server/render/path/path_picture.h"
#include "tests/evaluation/measures/measures.h"

namespace framelet::bench {
namespace {

/// Mean luminance of each block; blocks at the edges may be smaller.
std::vector<double> block_luminances(FloatImage const& picture) {
    constexpr int side = 8;
    std::vector<double> out;
    for (int top = 0; top < picture.height; top += side) {
        for (int left = 0; left < picture.width; left += side) {
            int const bottom = std::min(top + side, picture.height), right = std::min(left + side, picture.width);
            double sum = 0;
            for (int y = top; y < bottom; ++y) {
                for (int x = left; x < right; ++x) {
                    sum += static_cast<double>(luminance(picture.at(x, y)));
                }
            }
            out.push_back(sum / ((bottom - top) * (right - left)));
        }
    }
    return out;
}

double mean_of(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

nlohmann::json light_errors(FloatImage const& shown, FloatImage const& paths, float exposure) {
    FRAMELET_CHECK(shown.width == paths.width && shown.height == paths.height && !paths.rgb.empty());
    constexpr double darkest = 0.02;
    std::vector<double> const a = block_luminances(shown), b = block_luminances(paths);
    double const mean = mean_of(b);
    std::vector<double> errors;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double const scale = std::max(b[i], darkest * mean);
        errors.push_back(scale > 0 ? std::abs(a[i] - b[i]) / scale : 0);
    }
    auto const middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::ranges::nth_element(errors, middle);
    double const mse = mean_squared_error(to_display(shown, exposure), to_display(paths, exposure));
    return {{"median", *middle},
            {"mean", mean_of(errors)},
            {"bias", mean > 0 ? mean_of(a) / mean - 1 : 0},
            {"psnr", psnr_from_mse(mse)}};
}

} // namespace framelet::bench
