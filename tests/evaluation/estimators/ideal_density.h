// The oracle of the ideal sample density (004 section 5.1.2): a place of the image, rendered far more densely than the
// renderer ever would, and the frequencies below which nearly all of its energy lies.
#pragma once

#include <vector>

namespace framelet::bench {

/// Display-encoded luma of a square place over some time, on a regular grid.
struct SampleVolume {
    int side = 0; ///< samples along x and along y
    int times = 0;
    double pixels = 0; ///< side of the place
    double seconds = 0; ///< `times` intervals
    std::vector<float> luma; ///< [time][y][x]
};

struct OracleParameters {
    double share = 0.95; ///< of the energy that varies along an axis, to be captured
    double floor = 1.28e-6; ///< mean square that need not be captured: what rounding to bytes leaves, (1/255)^2 / 12
};

struct IdealDensity {
    double space_frequency = 0; ///< fs, cycles per pixel
    double time_frequency = 0; ///< ft, Hz

    double samples_per_pixel() const { return 4 * space_frequency * space_frequency; }
    double refreshes_per_second() const { return 2 * time_frequency; }
};

/// fs: the least frequency such that the square band max(|fx|, |fy|) <= fs, at all temporal frequencies, has its share
/// of the energy; ft the same in time at all spatial ones. Together they capture at least 2 share - 1. (004 eq. 5.3
/// looks for a small gradient of the norm and leaves the threshold open; a share is the same whatever the contrast.)
///
/// By Parseval's theorem the power spectrum in three dimensions, summed over all temporal frequencies, is the sum of
/// the spatial spectra of all times, and the same the other way round: these are what is computed. In time: mean of
/// each sample taken off, Hann window, so that the middle counts, where an estimator stands. In space: mean of each
/// time taken off; the place is mirrored at its borders instead of windowed, since all of it counts, and one pixel as
/// much as another. Between bins the share is interpolated. What does not vary more than `floor` has frequency 0.
IdealDensity ideal_density(SampleVolume const& volume, OracleParameters const& parameters);

} // namespace framelet::bench
