// A sample that was rendered and can be rendered again, to see whether what is shown of its place is still true.
#pragma once

#include "common/math.h"

namespace framelet {

struct Probe {
    Vec2 position{0, 0}; ///< pixels
    float spacing = 1; ///< footprint, pixels
    float luma = 0; ///< when it was rendered: display-encoded, [0, 1]
};

} // namespace framelet
