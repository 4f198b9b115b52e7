#include "tests/evaluation/methods/response/haar.h"

#include <algorithm>
#include <bit>

#include "common/error.h"

namespace framelet {
namespace {

bool is_square(std::size_t count) {
    return std::has_single_bit(count) && std::countr_zero(count) % 2 == 0;
}

} // namespace

void haar_forward(std::span<float> samples) {
    FRAMELET_CHECK(is_square(samples.size()));
    for (std::size_t stride = 1; stride < samples.size(); stride *= 4) {
        for (std::size_t i = 0; i < samples.size(); i += 4 * stride) {
            float const a = samples[i];
            float const b = samples[i + stride];
            float const c = samples[i + 2 * stride];
            float const d = samples[i + 3 * stride];
            samples[i] = 0.25f * ((a + b) + (c + d));
            samples[i + stride] = 0.25f * ((a - b) + (c - d));
            samples[i + 2 * stride] = 0.25f * ((a + b) - (c + d));
            samples[i + 3 * stride] = 0.25f * ((a - b) - (c - d));
        }
    }
}

float octave_energy(std::span<float const, framelet_samples> coefficients, std::size_t octave, std::size_t first,
                    std::size_t count) {
    std::size_t const stride = std::size_t{1} << (2 * octave);
    std::size_t const block = 4 * stride; // a coefficient stands for as many samples
    std::size_t const begin = first & ~(block - 1);
    std::size_t const end = std::max(first + count, begin + block);
    float sum = 0;
    for (std::size_t i = begin; i < end; i += block) {
        float const x = coefficients[i + stride];
        float const y = coefficients[i + 2 * stride];
        float const xy = coefficients[i + 3 * stride];
        sum += x * x + y * y + xy * xy;
    }
    return sum * static_cast<float>(block) / static_cast<float>(end - begin);
}

} // namespace framelet
