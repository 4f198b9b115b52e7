// Estimates what samples cost where the link is scarce: those of flat places take fewer bytes than others. In: the
// detail of a place. Out: bits of a sample, by level.
#pragma once

#include <array>

#include "server/sampling/held/sampling_level.h"

namespace framelet {

/// Cost of a sample, by level of sampling.
using LevelCosts = std::array<float, sampling_levels>;

/// Bits of a sample of each level, > 0 and finite: half the binary logarithm of its Haar coefficients' energy over that
/// of coding noise at 40 dB (the rate of Gaussian coefficients), and half a bit for what goes with it. `detail` >= 0:
/// as of `Piece`.
LevelCosts coded_bits(float detail);

} // namespace framelet
