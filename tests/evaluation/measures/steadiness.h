// How steadily an error goes: what crawls, flickers and jumps, and not what is merely wrong.
#pragma once

#include <array>

#include "common/image.h"

namespace framelet::bench {

/// Mean over pixels and RGB in [0, 1] of the squared second difference of the error over three pictures in a row, all
/// of one size; 0 where an error stays or grows evenly.
double unsteadiness(std::array<Picture, 3> const& shown, std::array<Picture, 3> const& reference);

} // namespace framelet::bench
