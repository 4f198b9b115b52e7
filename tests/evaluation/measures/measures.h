// Measures how far a shown picture is from the reference. Both as displayed: sRGB-encoded bytes, the same size.
#pragma once

#include <array>

#include "common/image.h"

namespace framelet::bench {

struct Measures {
    double mse = 0; ///< mean squared error over RGB in [0, 1]
    double psnr = 0; ///< dB
    double ssim = 1;
    double flip = 0;
};

/// Mean over pixels and RGB of the squared difference, values as stored, [0, 1].
double mean_squared_error(Picture const& shown, Picture const& reference);

/// PSNR in dB of a mean squared error in [0, 1]; 100 for errors of 1e-10 and less.
double psnr_from_mse(double mse);

/// Structural similarity (SSIM, [Wang 2004]) of luma: Gaussian window of 11x11 and sigma 1.5, K1 = 0.01, K2 = 0.03,
/// mean over the positions at which the window lies within the picture. A picture smaller than the window is one window
/// of equal weights.
double structural_similarity(Picture const& shown, Picture const& reference);

/// Pixels a degree of a display seen from 0.7 m, 0.7 m wide with 3840 pixels.
inline constexpr double usual_pixels_per_degree = 67.02;

/// Mean of LDR-FLIP ([Andersson 2020]), [0, 1].
double mean_flip(Picture const& shown, Picture const& reference, double pixels_per_degree = usual_pixels_per_degree);

/// Mean over pixels and RGB in [0, 1] of the squared second difference of the error over three pictures in a row, all
/// of one size; 0 where an error stays or grows evenly.
double unsteadiness(std::array<Picture, 3> const& shown, std::array<Picture, 3> const& reference);

/// Takes all measures of one shown picture (unsteadiness needs three). The result does not depend on the number of
/// threads.
Measures measure(Picture const& shown, Picture const& reference);

} // namespace framelet::bench
