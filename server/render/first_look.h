// A small picture of what is seen at first, by which exposure and light are chosen. In: a posed scene, a camera. Out:
// values.
#pragma once

#include <vector>

#include "common/camera.h"
#include "common/color.h"
#include "common/framelet/framelet.h"
#include "server/render/prepared/render_scene.h"

namespace framelet {

class PathLight;

/// The tiles of a picture of 64x48 pixels, a sample each: the mean of 16 rays or paths, and the depth in its middle.
using FirstLook = std::vector<Framelet>;

/// What this view shows. `light`: what finds the light by paths; null: it is found as framelets are rendered. The same
/// view gives the same look.
FirstLook take_first_look(RenderScene const& scene, Camera const& camera, PathLight const* light = nullptr);

/// The exposure that shows this well: 1 where the log-average luminance of what is hit is within what a display shows,
/// else what brings it to a middle grey; then as much less as keeps a tenth of what is hit, or half of the background,
/// from being burnt, the latter by one stop at most, or as much more as lifts a picture that is all dark.
float auto_exposure(FirstLook const& look);
float auto_exposure(RenderScene const& scene, Camera const& camera, PathLight const* light = nullptr);

/// How far what is hit differs between two looks of one view: mean of the absolute difference of blocks of 8x8 pixels,
/// in steps of 1/255 of the display's luma. What is noise in a pixel is not in a block.
float shown_difference(FirstLook const& one, FirstLook const& other, DisplayTransform const& transform);

} // namespace framelet
