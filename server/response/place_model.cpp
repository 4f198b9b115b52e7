#include "server/response/place_model.h"

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

constexpr float band_weight(int band) {
    return static_cast<float>(1 << band) / static_cast<float>(1 << pixel_level);
}

float energy_above(PlaceModel const& place, int level) {
    float sum = tail * place.energy.back();
    for (int band = level + 1; band < sampling_levels; ++band) {
        sum += place.energy[static_cast<std::size_t>(band)];
    }
    return sum;
}

/// Bands finer than a pixel are averaged away on the display and cannot become untrue.
int shown_level(int level) {
    return std::min(level, pixel_level);
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

float unresolved_error(PlaceModel const& place, int level) {
    float const unsampled = energy_above(place, level);
    if (level >= pixel_level) { // the mean over the samples of a pixel
        return unsampled / samples_per_pixel(level);
    }
    float missing = 0;
    for (int band = level + 1; band <= pixel_level; ++band) {
        missing += place.energy[static_cast<std::size_t>(band)];
    }
    return missing + alias_share * unsampled;
}

float drift_error(PlaceModel const& place, int level, float drift) {
    float sum = 0;
    float kept = std::exp(-drift * band_weight(0)); // of the band; the next one passes twice as fast
    for (int band = 0; band <= shown_level(level); ++band) {
        sum += 2 * place.energy[static_cast<std::size_t>(band)] * (1 - kept);
        kept *= kept;
    }
    return sum;
}

DriftBounds drift_bounds(PlaceModel const& place, int level) {
    DriftBounds bounds;
    for (int band = 0; band <= shown_level(level); ++band) {
        float const energy = 2 * place.energy[static_cast<std::size_t>(band)];
        bounds.most += energy;
        bounds.growth += energy * band_weight(band);
    }
    return bounds;
}

float drift_of_error(PlaceModel& place, int level, float error) {
    if (!(error > 0)) {
        return 0;
    }
    DriftBounds const bounds = drift_bounds(place, level);
    constexpr float most_share = 0.9f;
    if (error > most_share * bounds.most) {
        place.energy[0] = to_energy(place.energy[0] + 0.5f * (error / most_share - bounds.most));
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

namespace {

/// Mean energy of one octave of the coefficients [first, first + count), or of the block that they lie in.
float octave_energy(std::span<float const, framelet_samples> coefficients, std::size_t octave, std::size_t first,
                    std::size_t count) {
    std::size_t const stride = std::size_t{1} << (2 * octave);
    std::size_t const block = 4 * stride;
    std::size_t const begin = first & ~(block - 1);
    std::size_t const end = std::max(first + count, begin + block);
    float sum = 0;
    for (std::size_t i = begin; i < end; i += block) {
        float const x = coefficients[i + stride];
        float const y = coefficients[i + 2 * stride];
        float const xy = coefficients[i + 3 * stride];
        sum += x * x + y * y + xy * xy;
    }
    return sum * static_cast<float>(block) / static_cast<float>(end - begin);
}

} // namespace

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

/// Puts the energies of the octaves into their bands and carries what is known of finer bands along.
void learn_energy(PlaceModel& place, Observation const& seen) {
    std::array<float, sampling_levels> found{};
    int const coarsest_band = std::max(seen.level - static_cast<int>(framelet_octaves) + 1, 0);
    for (int octave = 0; octave < static_cast<int>(framelet_octaves); ++octave) {
        found[static_cast<std::size_t>(std::max(seen.level - octave, 0))] +=
            seen.energy[static_cast<std::size_t>(octave)];
    }
    auto const finest = static_cast<std::size_t>(seen.level);
    float const scale = place.finest_seen >= seen.level
                            ? std::clamp(to_energy(found[finest]) / to_energy(place.energy[finest]), 0.25f, 4.0f)
                            : 0;
    for (int band = coarsest_band; band <= seen.level; ++band) {
        auto const b = static_cast<std::size_t>(band);
        place.energy[b] = to_energy(found[b]);
    }
    for (auto b = finest + 1; b < place.energy.size(); ++b) {
        bool const known = static_cast<int>(b) <= place.finest_seen;
        place.energy[b] = to_energy(known ? scale * place.energy[b] : band_falloff * place.energy[b - 1]);
    }
    place.finest_seen = std::max(place.finest_seen, seen.level);
}

void learn_motion(PlaceModel& place, Observation const& seen) {
    float change = seen.mean_change;
    for (float const octave : seen.change) {
        change += octave;
    }
    // Newer evidence counts more; what does not change at all is taken at its word.
    constexpr float trust = 0.7f;
    float const drift = drift_of_error(place, seen.level, change);
    constexpr float least_seconds = 1e-4f; // so that it is finite
    float const motion = drift / std::max(seen.seconds, least_seconds);
    place.motion = motion > 0 ? place.motion + trust * (motion - place.motion) : 0;
}

} // namespace

void learn(PlaceModel& place, Observation const& seen) {
    learn_energy(place, seen);
    if (seen.has_change) {
        learn_motion(place, seen);
    }
}

} // namespace framelet
