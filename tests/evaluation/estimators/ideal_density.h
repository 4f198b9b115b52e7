// The oracle of the ideal sample density ([Stephens 2011] section 5.1.2): a place of the image, rendered far more
// densely than the renderer ever would, and the frequencies below which nearly all of its energy lies.
#pragma once

#include <vector>

namespace framelet::bench {

/// Display-encoded luma of a square place over some time, on a regular grid.
struct SampleVolume {
    int side = 0; ///< samples along x and along y
    int times = 0;
    int pixels = 0; ///< side of the place; divides `side`
    double seconds = 0; ///< `times` intervals
    std::vector<float> luma; ///< [time][y][x]
};

struct OracleParameters {
    double share = 0.95; ///< share to be captured of the energy that varies along an axis
    double floor = 1e-4; ///< mean square that need not be captured: 40 dB
};

struct IdealDensity {
    double space_frequency = 0; ///< fs, cycles per pixel
    double time_frequency = 0; ///< ft, Hz

    double samples_per_pixel() const { return 4 * space_frequency * space_frequency; }
    double refreshes_per_second() const { return 2 * time_frequency; }
};

/// fs: the least frequency such that the square band max(|fx|, |fy|) <= fs has its share of the energy, at all temporal
/// frequencies; ft the same in time, at the spatial frequencies that a pixel's mean lets pass: detail that is finer is
/// never displayed, and would flicker in time whenever anything moves. ([Stephens 2011] eq. 5.3 looks for a small
/// gradient of the cumulative norm and leaves the threshold open; a share is the same whatever the contrast.)
///
/// By Parseval's theorem the power spectrum in three dimensions, summed over all temporal frequencies, is the sum of
/// the spatial spectra of all times, and the same the other way round: these are what is computed. In time: mean of
/// each pixel taken off, Hann window, so that the middle counts, where an estimator stands. In space: mean of each time
/// taken off; the place is mirrored at its borders instead of windowed, since all of it counts, and one pixel as much
/// as another. Between bins the share is interpolated. What does not vary more than `floor` has frequency 0.
IdealDensity ideal_density(SampleVolume const& volume, OracleParameters const& parameters);

} // namespace framelet::bench
