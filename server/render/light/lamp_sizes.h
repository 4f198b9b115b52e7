// How large the lights of a scene are.
#pragma once

namespace framelet {

/// Sizes of lights that a scene file does not tell. 0: hard.
struct LampSizes {
    float sun = 0; ///< angular radius of directional lights, radians
    float lamp = 0; ///< radius of point and spot lights, metres
};

} // namespace framelet
