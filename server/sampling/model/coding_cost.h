// What samples cost where the link is what is scarce: those of flat places take fewer bytes than others. In: what is
// known of a place. Out: bits by level, estimated.
#pragma once

#include <array>

#include "server/sampling/model/place_model.h"

namespace framelet {

/// By level of sampling.
using LevelCosts = std::array<float, sampling_levels>;

/// Bits of a sample of each level, > 0 and finite: half the binary logarithm of its Haar coefficients' energy over that
/// of coding noise at 40 dB (the rate of Gaussian coefficients), and half a bit for what goes with it.
LevelCosts coded_bits(PlaceModel const& place);

} // namespace framelet
