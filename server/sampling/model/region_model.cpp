#include "server/sampling/model/region_model.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

/// No region is taken to be flatter than a quarter of a display step, so that each is looked at in full some time.
constexpr float least_energy = 1e-6f;
/// Energy that nothing exceeds: luma is in [0, 1], so that there is much to spare.
constexpr float most_energy = 4;
/// Energy of a band over that of the next coarser one, where nothing is known.
constexpr float band_falloff = 0.5f;
/// Energy of all that is finer than the finest band over that of this band, by the same falloff.
constexpr float tail = band_falloff / (1 - band_falloff);
/// The share of the unsampled energy that a tent filter lets through into the picture: (2/3)^2.
constexpr float alias_share = 4.0f / 9.0f;
/// A drift beyond which even the coarsest band has passed.
constexpr float most_drift = 64;
constexpr float most_motion = 1e6f; ///< drift a second
constexpr float most_decay = 1e3f;
/// The largest share of its bound that a change is taken for: beyond, all that is known is that the band has passed.
constexpr float most_share = 0.9f;

/// Bands finer than a pixel are averaged away on the display and cannot become untrue.
std::size_t shown_band(int level) {
    return static_cast<std::size_t>(std::min(level, pixel_level));
}

float to_energy(float value) {
    return value > least_energy ? std::min(value, most_energy) : least_energy; // NaN becomes the least
}

} // namespace

RegionModel unknown_region() {
    RegionModel region;
    float energy = 0.02f;
    for (float& band : region.energy) {
        band = energy;
        energy *= band_falloff;
    }
    return region;
}

LevelErrors level_errors(RegionModel const& region) {
    LevelErrors errors;
    float unsampled = tail * region.energy.back(); // energy of what is finer than the level
    float missing = 0; // of that, what a pixel could show
    for (int level = sampling_levels - 1; level >= 0; --level) {
        auto const l = static_cast<std::size_t>(level);
        // From `pixel_level` on a pixel shows the mean over its samples.
        errors.unresolved[l] =
            level >= pixel_level ? unsampled / samples_per_pixel(level) : missing + alias_share * unsampled;
        unsampled += region.energy[l];
        missing += level <= pixel_level ? region.energy[l] : 0;
    }
    DriftBounds sum;
    for (std::size_t level = 0; level < errors.drift.size(); ++level) {
        if (level == shown_band(static_cast<int>(level))) {
            sum.most += 2 * region.energy[level];
            sum.growth += 2 * region.energy[level] * region.decay[level];
        }
        errors.drift[level] = sum;
    }
    return errors;
}

float unresolved_error(RegionModel const& region, int level) {
    return level_errors(region).unresolved[static_cast<std::size_t>(level)];
}

float drift_error(RegionModel const& region, int level, float drift) {
    float sum = 0;
    if (!(drift > 0)) {
        return sum;
    }
    for (std::size_t band = 0; band <= shown_band(level); ++band) {
        sum += 2 * region.energy[band] * (1 - std::exp(-drift * region.decay[band]));
    }
    return sum;
}

DriftBounds drift_bounds(RegionModel const& region, int level) {
    return level_errors(region).drift[static_cast<std::size_t>(level)];
}

float drift_of_error(RegionModel& region, int level, float error) {
    if (!(error > 0)) {
        return 0;
    }
    DriftBounds const bounds = drift_bounds(region, level);
    if (error > most_share * bounds.most) {
        region.energy[0] = to_energy(region.energy[0] + 0.5f * (error / most_share - bounds.most));
    }
    if (!(bounds.growth > 0)) {
        region.decay = RegionModel::unknown_decay();
    }
    // `drift_error` is monotone: bisects the logarithm of the drift.
    float low = 1e-6f;
    float high = most_drift;
    for (int step = 0; step < 20; ++step) {
        float const middle = std::sqrt(low * high);
        (drift_error(region, level, middle) < error ? low : high) = middle;
    }
    return high;
}

Observation observe(int level, std::span<float const, framelet_samples> luma,
                    std::optional<std::span<float const, framelet_samples>> change, float seconds, std::size_t first,
                    std::size_t count) {
    Observation out;
    out.level = level;
    out.seconds = seconds;
    out.has_change = change.has_value() && seconds > 0;
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        out.energy[octave] = octave_energy(luma, octave, first, count);
        if (out.has_change) {
            out.change[octave] = octave_energy(*change, octave, first, count);
        }
    }
    if (out.has_change) {
        out.mean_change = (*change)[0] * (*change)[0];
    }
    return out;
}

void accumulate(Observation& sum, Observation const& more) {
    sum.level = more.level;
    sum.has_change |= more.has_change;
    sum.seconds += more.seconds;
    sum.mean_change += more.mean_change;
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        sum.energy[octave] += more.energy[octave];
        sum.change[octave] += more.change[octave];
    }
}

Observation mean_of(Observation const& sum, int count) {
    FRAMELET_CHECK(count > 0);
    float const share = 1.0f / static_cast<float>(count);
    Observation mean = sum;
    mean.seconds *= share;
    mean.mean_change *= share;
    for (std::size_t octave = 0; octave < framelet_octaves; ++octave) {
        mean.energy[octave] *= share;
        mean.change[octave] *= share;
    }
    return mean;
}

namespace {

/// Octaves of an observation put into their bands; what is coarser than the coarsest band goes into that.
std::array<float, sampling_levels> by_band(int level, OctaveEnergies const& octaves) {
    std::array<float, sampling_levels> bands{};
    for (int octave = 0; octave < static_cast<int>(framelet_octaves); ++octave) {
        bands[static_cast<std::size_t>(std::max(level - octave, 0))] += octaves[static_cast<std::size_t>(octave)];
    }
    return bands;
}

/// The coarsest band that tiles of this level see all of.
std::size_t coarsest_band(int level) {
    return static_cast<std::size_t>(std::max(level - static_cast<int>(framelet_octaves) + 1, 0));
}

/// Takes over the energies of the observed bands, and carries what is known of finer bands along.
void learn_energy(RegionModel& region, Observation const& seen) {
    auto const found = by_band(seen.level, seen.energy);
    auto const finest = static_cast<std::size_t>(seen.level);
    float const scale = region.finest_seen >= seen.level
                            ? std::clamp(to_energy(found[finest]) / to_energy(region.energy[finest]), 0.25f, 4.0f)
                            : 0;
    for (std::size_t band = coarsest_band(seen.level); band <= finest; ++band) {
        region.energy[band] = to_energy(found[band]);
    }
    for (std::size_t band = finest + 1; band < region.energy.size(); ++band) {
        bool const known = static_cast<int>(band) <= region.finest_seen;
        region.energy[band] = to_energy(known ? scale * region.energy[band] : band_falloff * region.energy[band - 1]);
    }
    region.finest_seen = std::max(region.finest_seen, seen.level);
}

/// Learns the drift a second of each band from what has changed of it; then the motion that they have in common, and
/// each one's own decay.
void learn_motion(RegionModel& region, Observation const& seen) {
    auto change = by_band(seen.level, seen.change);
    std::size_t const coarsest = coarsest_band(seen.level);
    auto const finest = static_cast<std::size_t>(seen.level);
    change[coarsest > 0 ? coarsest - 1 : 0] += seen.mean_change;
    // Newer evidence counts more; what does not change at all is taken at its word.
    constexpr float trust = 0.7f;
    constexpr float least_seconds = 1e-4f; // so that rates are finite
    float const seconds = std::max(seen.seconds, least_seconds);
    // A finer band that was not sampled goes with the finest one that was, as it last did; that memory fades.
    constexpr float forgetting = 0.25f;
    std::array<float, sampling_levels> rates{};
    for (std::size_t band = 0; band < rates.size(); ++band) {
        float const before = region.motion * region.decay[band];
        float const coarser = band > 0 ? 2 * rates[band - 1] : before;
        if (band <= finest && (band >= coarsest || change[band] > 0)) {
            float const gone = std::min(change[band], most_energy);
            region.energy[band] = std::max(region.energy[band], to_energy(0.5f * gone / most_share));
            float const share = std::min(gone / (2 * region.energy[band]), most_share);
            float const rate = -std::log1p(-share) / seconds;
            bool const passed = share >= 0.99f * most_share; // at least that fast
            rates[band] = passed ? std::max(rate, std::min(before, coarser))
                                 : before + (rate > 0 ? trust : 1.0f) * (rate - before);
        } else if (band > finest) {
            float const doubled = static_cast<float>(1 << (band - finest));
            float const known = region.decay[finest] > 0 ? region.decay[band] / region.decay[finest] : doubled;
            rates[band] = rates[finest] * (known + forgetting * (doubled - known));
        } else {
            rates[band] = before;
        }
    }
    float growth = 0;
    float as_one = 0;
    auto const unknown = RegionModel::unknown_decay();
    for (std::size_t band = 0; band <= shown_band(seen.level); ++band) {
        growth += region.energy[band] * rates[band];
        as_one += region.energy[band] * unknown[band];
    }
    region.motion = std::min(growth / as_one, most_motion);
    if (region.motion > 0) {
        for (std::size_t band = 0; band < rates.size(); ++band) {
            region.decay[band] = std::min(rates[band] / region.motion, most_decay);
        }
    } else {
        region.motion = 0;
        region.decay = unknown;
    }
}

} // namespace

float unresolved_error(Observation const& seen) {
    FRAMELET_CHECK(seen.level >= pixel_level);
    return tail * to_energy(seen.energy[0]) / samples_per_pixel(seen.level);
}

void learn(RegionModel& region, Observation const& seen) {
    learn_energy(region, seen);
    if (seen.has_change) {
        learn_motion(region, seen);
    }
}

} // namespace framelet
