// Models one region of the picture: how much detail it has at each spacing of samples and how fast that detail passes.
// In: rendered framelets, beside what the same tile showed before. Out: the error that a viewer would see, in mean
// squared difference of display-encoded luma, for any spacing and any age.
//
// The model (of our own, in no paper): detail is kept by bands, each of them what one more level of the quadtree
// resolves. A band that is not sampled is missing from the picture and costs its energy E. A band that is sampled but
// no longer true costs up to twice its energy, 2 E (1 - exp(-drift w)), where drift is how far the content has moved
// since, in units common to all bands, and w is the band's decay: how much sooner than others it passes. Where that has
// not been seen, w doubles from a band to the next finer one.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "common/framelet/tile.h"
#include "server/sampling/model/haar.h"

namespace framelet {

/// Levels of sampling, from the coarsest tiles (0) over one sample a pixel to the finest.
inline constexpr int sampling_levels = coarsest_levels + 1 + finest_levels;
inline constexpr int pixel_level = coarsest_levels;

/// Samples per pixel of a level: 1/64 .. 16.
constexpr float samples_per_pixel(int level) {
    constexpr std::array<float, sampling_levels> of_level{1.0f / 64, 1.0f / 16, 1.0f / 4, 1, 4, 16};
    return of_level[static_cast<std::size_t>(level)];
}

struct RegionModel {
    /// Energy of band b: what level b resolves beyond level b - 1. Band 0: all that level 0 resolves.
    std::array<float, sampling_levels> energy{};
    int finest_seen = -1; ///< finest band that was observed, finer ones are extrapolated; -1: nothing is known
    float motion = 0; ///< drift a second; 1 is about the time that detail of a pixel takes to be elsewhere
    /// Decay of each band, w, with the drift: how soon it passes; 1 for the band of a pixel where all of it moves as
    /// one.
    std::array<float, sampling_levels> decay = unknown_decay();

    /// The decay where none has been seen: it doubles from a band to the next finer one.
    static constexpr std::array<float, sampling_levels> unknown_decay() {
        std::array<float, sampling_levels> decay{};
        for (std::size_t band = 0; band < decay.size(); ++band) {
            decay[band] = static_cast<float>(1 << band) / static_cast<float>(1 << pixel_level);
        }
        return decay;
    }

    bool operator==(RegionModel const&) const = default;
};

/// A region that nothing is known of: detail as pictures have it on average (their power falls with the square of
/// frequency, which halves the energy from band to band).
RegionModel unknown_region();

/// Mean squared error of sampling at this level, fresh: what is missing, and what it puts into the wrong bands.
float unresolved_error(RegionModel const& region, int level);

/// Mean squared error by what has changed since, for samples of this level: 0 at drift 0, growing, bounded.
float drift_error(RegionModel const& region, int level, float drift);

/// Bounds of `drift_error`: `most`, what it tends to, and `growth`, its slope at drift 0.
struct DriftBounds {
    float most = 0, growth = 0;
};
DriftBounds drift_bounds(RegionModel const& region, int level);

/// `unresolved_error` and `drift_bounds` of every level.
struct LevelErrors {
    std::array<float, sampling_levels> unresolved{};
    std::array<DriftBounds, sampling_levels> drift{};
};
LevelErrors level_errors(RegionModel const& region);

/// The drift at which `drift_error` is `error`. Where the bands have too little energy for so much error, band 0 is
/// given more: something has come that they knew nothing of.
float drift_of_error(RegionModel& region, int level, float error);

/// Observation of a part of the samples of a rendered framelet.
struct Observation {
    int level = 0;
    OctaveEnergies energy{}; ///< by octave of the framelet, 0 the finest
    bool has_change = false; ///< the tile has been rendered before
    OctaveEnergies change{}; ///< energies of the difference to then
    float mean_change = 0; ///< square of the difference of the means
    float seconds = 0; ///< between then and now
};

/// Observes samples [first, first + count) of a framelet in Morton order; `count` is a power of 4. Octaves coarser than
/// the part are those of the blocks that it lies in. `luma`: Haar coefficients of display-encoded luma; `change`: those
/// of its difference to `seconds` before, where the same tile was rendered then.
Observation observe(int level, std::span<float const, framelet_samples> luma,
                    std::optional<std::span<float const, framelet_samples>> change, float seconds, std::size_t first,
                    std::size_t count);

/// Sums up observations of tiles that share a region; `mean_of` makes their mean of the sum.
void accumulate(Observation& sum, Observation const& more);
Observation mean_of(Observation const& sum, int count);

/// Mean squared error that the mean over a pixel's samples leaves, by the observation alone; for levels from
/// `pixel_level` on.
float unresolved_error(Observation const& seen);

/// Takes an observation into account. All results are finite and not below 0 for any finite input.
void learn(RegionModel& region, Observation const& observation);

} // namespace framelet
