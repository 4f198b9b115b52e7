// How far light is off the paths' light. In: two pictures of radiance. Out: figures.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/image.h"

namespace framelet::bench {

/// Of blocks of 8x8 pixels, so that what is left of the noise of `paths` counts little: median and mean of the relative
/// error of their luminance, which of dark ones is taken of a fiftieth of the picture's mean. `bias`: of the mean
/// luminance, relative. `psnr`: of pixels as a display shows them, dB.
nlohmann::json light_errors(FloatImage const& shown, FloatImage const& paths, float exposure);

} // namespace framelet::bench
