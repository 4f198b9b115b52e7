#include "server/response/haar.h"

#include "common/error.h"

namespace framelet {
namespace {

bool is_square(std::size_t count) {
    return std::has_single_bit(count) && std::countr_zero(count) % 2 == 0;
}

/// Sums of the squares of value(i) by octave, over all i > 0.
template <class Value>
OctaveEnergies sum_by_octave(Value&& value) {
    OctaveEnergies sums{};
    constexpr auto count = static_cast<std::size_t>(framelet_samples);
    for (std::size_t octave = 0, stride = 1; octave < framelet_octaves; ++octave, stride *= 4) {
        float sum = 0;
        for (std::size_t i = 0; i < count; i += 4 * stride) {
            float const x = value(i + stride);
            float const y = value(i + 2 * stride);
            float const xy = value(i + 3 * stride);
            sum += x * x + y * y + xy * xy;
        }
        // A coefficient stands for 4^(octave + 1) samples.
        sums[octave] = sum * static_cast<float>(4 * stride) / static_cast<float>(count);
    }
    return sums;
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

void haar_inverse(std::span<float> coefficients) {
    FRAMELET_CHECK(is_square(coefficients.size()));
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

OctaveEnergies octave_energies(std::span<float const, framelet_samples> coefficients) {
    return sum_by_octave([&](std::size_t i) { return coefficients[i]; });
}

OctaveDifferences octave_differences(std::span<float const, framelet_samples> a,
                                     std::span<float const, framelet_samples> b) {
    float const mean = a[0] - b[0];
    return {sum_by_octave([&](std::size_t i) { return a[i] - b[i]; }), mean * mean};
}

} // namespace framelet
