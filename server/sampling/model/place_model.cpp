#include "server/sampling/model/place_model.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

/// No place is taken to be flatter than a quarter of a display step, so that each is looked at in full some time.
constexpr float least_energy = 1e-6f;
/// Of the display's range, with much to spare: what nothing exceeds.
constexpr float most_energy = 4;
/// From one band to the next finer one where nothing is known.
constexpr float band_falloff = 0.5f;
/// What is finer than the finest band, by the same falloff.
constexpr float tail = band_falloff / (1 - band_falloff);
/// How much of the unsampled energy a tent filter lets through into the picture: (2/3)^2.
constexpr float alias_share = 4.0f / 9.0f;
/// A drift beyond which even the coarsest band has passed.
constexpr float most_drift = 64;
constexpr float most_motion = 1e6f; ///< a second
constexpr float most_pace = 1e3f;
/// Of its bound, that a change is taken for at most: beyond, all that is known is that it has passed.
constexpr float most_share = 0.9f;

/// Bands finer than a pixel are averaged away on the display and cannot become untrue.
std::size_t shown_band(int level) {
    return static_cast<std::size_t>(std::min(level, pixel_level));
}

float to_energy(float value) {
    return value > least_energy ? std::min(value, most_energy) : least_energy; // NaN becomes the least
}

} // namespace

PlaceModel unknown_place() {
    PlaceModel place;
    float energy = 0.02f;
    for (float& band : place.energy) {
        band = energy;
        energy *= band_falloff;
    }
    return place;
}

LevelErrors level_errors(PlaceModel const& place) {
    LevelErrors errors;
    float unsampled = tail * place.energy.back(); // finer than the level
    float missing = 0; // of that, what a pixel could show
    for (int level = sampling_levels - 1; level >= 0; --level) {
        auto const l = static_cast<std::size_t>(level);
        // From a pixel on, the mean over its samples.
        errors.unresolved[l] =
            level >= pixel_level ? unsampled / samples_per_pixel(level) : missing + alias_share * unsampled;
        unsampled += place.energy[l];
        missing += level <= pixel_level ? place.energy[l] : 0;
    }
    DriftBounds sum;
    for (std::size_t level = 0; level < errors.drift.size(); ++level) {
        if (level == shown_band(static_cast<int>(level))) {
            sum.most += 2 * place.energy[level];
            sum.growth += 2 * place.energy[level] * place.pace[level];
        }
        errors.drift[level] = sum;
    }
    return errors;
}

float unresolved_error(PlaceModel const& place, int level) {
    return level_errors(place).unresolved[static_cast<std::size_t>(level)];
}

float drift_error(PlaceModel const& place, int level, float drift) {
    float sum = 0;
    if (!(drift > 0)) {
        return sum;
    }
    for (std::size_t band = 0; band <= shown_band(level); ++band) {
        sum += 2 * place.energy[band] * (1 - std::exp(-drift * place.pace[band]));
    }
    return sum;
}

DriftBounds drift_bounds(PlaceModel const& place, int level) {
    return level_errors(place).drift[static_cast<std::size_t>(level)];
}

float drift_of_error(PlaceModel& place, int level, float error) {
    if (!(error > 0)) {
        return 0;
    }
    DriftBounds const bounds = drift_bounds(place, level);
    if (error > most_share * bounds.most) {
        place.energy[0] = to_energy(place.energy[0] + 0.5f * (error / most_share - bounds.most));
    }
    if (!(bounds.growth > 0)) {
        place.pace = PlaceModel::unknown_pace();
    }
    // Monotone: halving the interval of the logarithm.
    float low = 1e-6f;
    float high = most_drift;
    for (int step = 0; step < 20; ++step) {
        float const middle = std::sqrt(low * high);
        (drift_error(place, level, middle) < error ? low : high) = middle;
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

/// Carries what is known of finer bands along.
void learn_energy(PlaceModel& place, Observation const& seen) {
    auto const found = by_band(seen.level, seen.energy);
    auto const finest = static_cast<std::size_t>(seen.level);
    float const scale = place.finest_seen >= seen.level
                            ? std::clamp(to_energy(found[finest]) / to_energy(place.energy[finest]), 0.25f, 4.0f)
                            : 0;
    for (std::size_t band = coarsest_band(seen.level); band <= finest; ++band) {
        place.energy[band] = to_energy(found[band]);
    }
    for (std::size_t band = finest + 1; band < place.energy.size(); ++band) {
        bool const known = static_cast<int>(band) <= place.finest_seen;
        place.energy[band] = to_energy(known ? scale * place.energy[band] : band_falloff * place.energy[band - 1]);
    }
    place.finest_seen = std::max(place.finest_seen, seen.level);
}

/// Drift a second of each band, from what has changed of it; then what they have in common, and each one's own pace.
void learn_motion(PlaceModel& place, Observation const& seen) {
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
        float const before = place.motion * place.pace[band];
        float const coarser = band > 0 ? 2 * rates[band - 1] : before;
        if (band <= finest && (band >= coarsest || change[band] > 0)) {
            float const gone = std::min(change[band], most_energy);
            place.energy[band] = std::max(place.energy[band], to_energy(0.5f * gone / most_share));
            float const share = std::min(gone / (2 * place.energy[band]), most_share);
            float const rate = -std::log1p(-share) / seconds;
            bool const passed = share >= 0.99f * most_share; // at least that fast
            rates[band] = passed ? std::max(rate, std::min(before, coarser))
                                 : before + (rate > 0 ? trust : 1.0f) * (rate - before);
        } else if (band > finest) {
            float const doubled = static_cast<float>(1 << (band - finest));
            float const known = place.pace[finest] > 0 ? place.pace[band] / place.pace[finest] : doubled;
            rates[band] = rates[finest] * (known + forgetting * (doubled - known));
        } else {
            rates[band] = before;
        }
    }
    float growth = 0;
    float as_one = 0;
    auto const unknown = PlaceModel::unknown_pace();
    for (std::size_t band = 0; band <= shown_band(seen.level); ++band) {
        growth += place.energy[band] * rates[band];
        as_one += place.energy[band] * unknown[band];
    }
    place.motion = std::min(growth / as_one, most_motion);
    if (place.motion > 0) {
        for (std::size_t band = 0; band < rates.size(); ++band) {
            place.pace[band] = std::min(rates[band] / place.motion, most_pace);
        }
    } else {
        place.motion = 0;
        place.pace = unknown;
    }
}

} // namespace

float unresolved_error(Observation const& seen) {
    FRAMELET_CHECK(seen.level >= pixel_level);
    return tail * to_energy(seen.energy[0]) / samples_per_pixel(seen.level);
}

void learn(PlaceModel& place, Observation const& seen) {
    learn_energy(place, seen);
    if (seen.has_change) {
        learn_motion(place, seen);
    }
}

} // namespace framelet
