// Pictures beside the stills of the same moments: one picture of them all, and how much they differ. Values.
#pragma once

#include <span>

#include "common/image.h"

namespace framelet {

struct ShownAndStill {
    Picture shown;
    Picture still; ///< what the same view comes to once all stands still
};

/// The pairs side by side, what was shown above its still, with white lines between. At least one pair; all pictures of
/// one size.
Picture contact_sheet(std::span<ShownAndStill const> pairs);

/// The difference of two pictures of one size: the mean over pixels and colours, 1 being that of black and white.
double mean_difference(Picture const& a, Picture const& b);

} // namespace framelet
