// A camera's flight through scenes that have none of their own. In: where it begins. Out: where it is then.
#pragma once

#include "common/camera.h"

namespace framelet::bench {

/// Half of the median depth (metres) a second to the right, turning by 30 degrees a second to the left.
Camera flown(Camera camera, float median_depth, double seconds);

} // namespace framelet::bench
