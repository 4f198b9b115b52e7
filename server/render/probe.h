// A sample that was rendered and can be rendered again, to see whether what is shown of its place is still true.
#pragma once

#include <span>

#include "common/math.h"

namespace framelet {

struct Probe {
    Vec2 position{0, 0}; ///< pixels
    float spacing = 1; ///< footprint, pixels
    float luma = 0; ///< when it was rendered: display-encoded, [0, 1]
    float light = 0; ///< by which that was, as of `SampleLight`, where it is to be compared; else 0
};

/// What the light cache does for a sample.
struct SampleLight {
    float light = 0; ///< luminance of the irradiance / pi that it says; 0: nothing
    float share = 0; ///< of the sample's radiance that comes of it, [0, 1]
};

/// What probes really show, in their order.
struct ProbeLooks {
    std::span<float const> luma; ///< display-encoded, [0, 1]
    std::span<SampleLight const> light{}; ///< empty: there is no light cache
};

} // namespace framelet
