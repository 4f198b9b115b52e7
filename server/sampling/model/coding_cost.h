// Estimates what samples cost where the link is scarce: those of flat regions take fewer bytes than others. In: what is
// known of a region. Out: bits of a sample, by level.
#pragma once

#include <array>

#include "server/sampling/model/region_model.h"

namespace framelet {

/// Cost of a sample, by level of sampling.
using LevelCosts = std::array<float, sampling_levels>;

/// Bits of a sample of each level, > 0 and finite: half the binary logarithm of its Haar coefficients' energy over that
/// of coding noise at 40 dB (the rate of Gaussian coefficients), and half a bit for what goes with it.
LevelCosts coded_bits(RegionModel const& region);

} // namespace framelet
