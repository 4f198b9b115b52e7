#include "server/sampling/held/coding_cost.h"

#include <algorithm>
#include <cmath>

namespace framelet {
namespace {

constexpr float noise = 1e-4f;
constexpr float least_bits = 0.5f;
constexpr float finest_share = 0.75f; ///< of a framelet's coefficients; each coarser octave has a quarter of the last
constexpr int octaves = 4; ///< of a framelet

} // namespace

LevelCosts coded_bits(float detail) {
    LevelCosts half_logs;
    for (int level = 0; level < sampling_levels; ++level) { // samples so far apart differ by about so much
        half_logs[static_cast<std::size_t>(level)] = 0.5f * std::log2(1 + detail * spacing_of(level) / noise);
    }
    LevelCosts out;
    for (int level = 0; level < sampling_levels; ++level) {
        float bits = least_bits;
        float share = finest_share;
        for (int octave = 0; octave < octaves; ++octave, share *= 0.25f) {
            bits += share * half_logs[static_cast<std::size_t>(std::max(level - octave, 0))];
        }
        out[static_cast<std::size_t>(level)] = bits;
    }
    return out;
}

} // namespace framelet
