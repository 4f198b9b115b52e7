// Haar transform ([Haar 1910]) of a square of samples in Morton order, in place. In: samples; out: the mean at index 0
// and, octave by octave, how each block of 2x2 differs from its mean.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "common/framelet/tile.h"

namespace framelet {

/// Octaves of a framelet; 0 is the finest (differences of neighbouring samples).
inline constexpr std::size_t framelet_octaves = 4;

/// Transforms `samples`, 4^n values. Low pass is the mean of a pair, high pass half its difference ([Stephens 2011] eq.
/// 5.16). In Morton order the four values of a block lie side by side; of a block at index i of octave o, the mean
/// stays at i and the differences in x, in y and in both go to i + 4^o, i + 2 * 4^o and i + 3 * 4^o.
void haar_forward(std::span<float> samples);

/// Mean energy of one octave of the coefficients [first, first + count), `count` a power of 4, or of the block that
/// they lie in where the octave is coarser: what the octave adds to the mean square of the samples. Over a whole
/// framelet the octaves and the square of the mean add up to the mean square (Parseval).
float octave_energy(std::span<float const, framelet_samples> coefficients, std::size_t octave, std::size_t first,
                    std::size_t count);

/// Energy of each octave.
using OctaveEnergies = std::array<float, framelet_octaves>;

} // namespace framelet
