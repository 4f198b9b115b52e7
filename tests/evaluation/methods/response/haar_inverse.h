// Undoes `haar_forward`: what the transform's tests compare with.
#pragma once

#include <cstddef>
#include <span>

namespace framelet {

inline void haar_inverse(std::span<float> coefficients) {
    for (std::size_t stride = coefficients.size() / 4; stride > 0; stride /= 4) {
        for (std::size_t i = 0; i < coefficients.size(); i += 4 * stride) {
            float const mean = coefficients[i];
            float const x = coefficients[i + stride];
            float const y = coefficients[i + 2 * stride];
            float const xy = coefficients[i + 3 * stride];
            coefficients[i] = (mean + x) + (y + xy);
            coefficients[i + stride] = (mean - x) + (y - xy);
            coefficients[i + 2 * stride] = (mean + x) - (y + xy);
            coefficients[i + 3 * stride] = (mean - x) - (y - xy);
        }
    }
}

} // namespace framelet
