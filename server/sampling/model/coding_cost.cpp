#include "server/sampling/model/coding_cost.h"

#include <algorithm>
#include <cmath>

namespace framelet {
namespace {

constexpr float noise = 1e-4f;
constexpr float least_bits = 0.5f;
constexpr float finest_share = 0.75f; ///< of a framelet's coefficients; each coarser octave has a quarter of the last

} // namespace

LevelCosts coded_bits(RegionModel const& region) {
    LevelCosts half_logs;
    for (std::size_t band = 0; band < half_logs.size(); ++band) {
        half_logs[band] = 0.5f * std::log2(1 + region.energy[band] / noise);
    }
    LevelCosts out;
    for (std::size_t level = 0; level < out.size(); ++level) {
        out[level] = least_bits;
        float share = finest_share;
        std::size_t const octaves = std::min(level + 1, static_cast<std::size_t>(framelet_octaves));
        for (std::size_t octave = 0; octave < octaves; ++octave, share *= 0.25f) {
            out[level] += share * half_logs[level - octave];
        }
    }
    return out;
}

} // namespace framelet
