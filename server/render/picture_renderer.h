// Whole pictures before exposure and tone mapping. In: a posed scene, a camera. Out: radiance.
#pragma once

#include "common/camera.h"
#include "common/image.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {

/// Mean radiance of `samples_per_side`^2 samples a pixel, on the grid that framelets use: 1, 2, 4 or 8.
FloatImage render_radiance(RenderScene const& scene, Camera const& camera, Viewport viewport, int samples_per_side);

} // namespace framelet
