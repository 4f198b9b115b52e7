#include "tests/evaluation/measures/filter.h"

#include <algorithm>

namespace framelet::bench {

Plane filter(Plane const& plane, std::span<float const> across, std::span<float const> down) {
    std::size_t const width = static_cast<std::size_t>(plane.width);
    std::ptrdiff_t const radius = std::ssize(across) / 2;
    Plane rows(plane.width, plane.height);
    std::vector<float> padded(width + across.size() - 1);
    for (std::size_t y = 0; y < static_cast<std::size_t>(plane.height); ++y) {
        float const* const in = &plane.values[y * width];
        std::fill_n(padded.begin(), radius, in[0]);
        std::copy_n(in, width, padded.begin() + radius);
        std::fill(padded.begin() + radius + plane.width, padded.end(), in[width - 1]);
        float* const out = &rows.values[y * width];
        for (std::size_t k = 0; k < across.size(); ++k) {
            for (std::size_t x = 0; x < width; ++x) {
                out[x] += across[k] * padded[x + k];
            }
        }
    }
    Plane result(plane.width, plane.height);
    std::ptrdiff_t const below = std::ssize(down) / 2;
    for (int y = 0; y < plane.height; ++y) {
        float* const out = &result.values[static_cast<std::size_t>(y) * width];
        for (std::size_t k = 0; k < down.size(); ++k) {
            std::ptrdiff_t const from = std::clamp<std::ptrdiff_t>(y + std::ptrdiff_t(k) - below, 0, plane.height - 1);
            float const* const in = &rows.values[static_cast<std::size_t>(from) * width];
            for (std::size_t x = 0; x < width; ++x) {
                out[x] += down[k] * in[x];
            }
        }
    }
    return result;
}

} // namespace framelet::bench
