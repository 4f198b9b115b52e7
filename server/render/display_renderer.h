// Tiles in, framelets as the viewer gets them out: display samples, and apart from them what reprojection needs. Where
// one ray a sample is not enough, each sample is the mean of four.
#pragma once

#include "common/framelet/framelet.h"
#include "server/render/framelet_renderer.h"
#include "server/render/rays_per_sample.h"

namespace framelet {

/// A quarter of the samples of the tile that `child` is a child of: each the mean of four of the child's, in the
/// display's light, as the viewer averages samples over a pixel. Depth and what goes with it are those of the surface
/// that most of the four show, in the middle of what they show of it. `will_be_moved`: by the viewer; then what never
/// moves gets no light of bodies before it, which would stay there when they have gone. `geometry` and `display` are of
/// that tile; body and velocity grow when there are some. Finite for finite radiance.
void merge_child(Framelet const& child, float exposure, bool will_be_moved, Framelet& geometry,
                 DisplayFramelet& display);

/// One framelet on the calling thread, at the places of seed 0. `geometry` gets all but the radiance; `scratch` is
/// overwritten, and its room is reused. `rays_per_sample`: single_ray or four_rays, those as `merge_child` has it.
/// Returns how many rays that took, shadow and mirror rays included.
std::uint32_t render_display(RenderScene const& scene, ViewRays const& rays, ImagePlane const& plane, Tile tile,
                             float exposure, int rays_per_sample, bool will_be_moved, Framelet& scratch,
                             Framelet& geometry, DisplayFramelet& display);

} // namespace framelet
