// Renders a whole picture by paths: the reference of evaluation and tests. In: a posed scene, a camera. Out: radiance.
#pragma once

#include "common/camera.h"
#include "common/color.h"
#include "common/image.h"
#include "server/render/path/path_options.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {

/// The mean radiance of `options.paths` paths through each pixel, before exposure and tone mapping. The same options
/// give the same picture, whatever the number of threads.
FloatImage render_paths(RenderScene const& scene, Camera const& camera, Viewport viewport, PathOptions const& options);

/// The picture as a viewer shows it: each pixel's mean radiance tone-mapped and encoded.
Picture to_display(FloatImage const& radiance, DisplayTransform const& transform);

} // namespace framelet
