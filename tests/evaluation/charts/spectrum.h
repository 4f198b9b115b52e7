// Power spectra of pictures and of sequences, and their slopes on a log-log scale: about -2 in natural images, less
// steep in computer graphics (004 §1.3.4, figs 1.3 and 1.4, which are spatial; the temporal one is our analogue).
//
// Taken of luma as stored (sRGB-encoded, Rec.709 weights, [0, 1]): 004 does not name a transfer function, photographs
// come encoded, and its error measure (eq. 7.1) too compares pixels as stored.
#pragma once

#include <span>
#include <vector>

#include "common/image.h"

namespace framelet::bench {

struct SpectrumPoint {
    double frequency = 0; ///< cycles per pixel or per picture
    double power = 0; ///< mean over the bin; white noise of variance v has power v at every frequency

    bool operator==(SpectrumPoint const&) const = default;
};

/// Mean power of rings of one cycle per shorter side, from the first to half a cycle per pixel: the window's mean taken
/// off, Hann window over the whole picture, DFT of whatever size. Empty for pictures less than two pixels wide or high.
std::vector<SpectrumPoint> radial_power(Picture const& picture);

/// The same along time: mean over all pixels of the power at 1, 2, ... cycles per sequence. Empty for less than two
/// pictures. InputError where the pictures differ in size.
std::vector<SpectrumPoint> temporal_power(std::span<Picture const> pictures);

/// Slope of a line through log power over log frequency by least squares, each octave of equal weight. From the third
/// point on, as the window spreads the mean and the slowest wave over the first two, to 0.25 cycles, above which pixel
/// filter and aliasing bend the spectrum. Powers count as at least 1e-12, a millionth of what rounding to bytes leaves:
/// what is flat has slope 0. So has what is too small for three such points (less than 20 pixels or pictures).
double log_log_slope(std::span<SpectrumPoint const> spectrum);

/// Slope of `radial_power`.
double power_spectrum_slope(Picture const& picture);

/// Slope of `temporal_power`.
double temporal_spectrum_slope(std::span<Picture const> pictures);

} // namespace framelet::bench
