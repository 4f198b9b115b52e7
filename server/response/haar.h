// Haar transform of a square of samples in Morton order, in place. In: samples; out: the mean at index 0 and, octave by
// octave, what each block of 2x2 differs from its mean.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>

#include "common/tile.h"

namespace framelet {

/// Octaves of a framelet; 0 is the finest (differences of neighbouring samples).
inline constexpr std::size_t framelet_octaves = 4;

/// `samples`: 4^n values. Low pass is the mean of a pair, high pass half its difference (004 eq. 5.16). In Morton order
/// the four values of a block lie side by side; of a block at index i of octave o, the mean stays at i and the
/// differences in x, in y and in both go to i + 4^o, i + 2 * 4^o and i + 3 * 4^o.
void haar_forward(std::span<float> samples);
void haar_inverse(std::span<float> coefficients);

/// Octave of the coefficient at `index` > 0.
constexpr std::size_t haar_octave(std::size_t index) {
    return static_cast<std::size_t>(std::countr_zero(index)) / 2;
}

/// Energy of each octave of a framelet: what the octave adds to the mean square of the samples. All of them and the
/// square of the mean add up to the mean square (Parseval).
using OctaveEnergies = std::array<float, framelet_octaves>;
OctaveEnergies octave_energies(std::span<float const, framelet_samples> coefficients);

/// Energy of each octave of the difference of two framelets, from their coefficients; `mean`: square of the difference
/// of their means.
struct OctaveDifferences {
    OctaveEnergies octaves{};
    float mean = 0;
};
OctaveDifferences octave_differences(std::span<float const, framelet_samples> a,
                                     std::span<float const, framelet_samples> b);

} // namespace framelet
