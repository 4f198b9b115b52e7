// Renders framelets as the viewer gets them. In: tiles. Out: display samples, and apart from them what reprojection
// needs. Where one ray a sample is not enough, each sample is the mean of four.
#pragma once

#include "common/color.h"
#include "common/framelet/framelet.h"
#include "server/render/framelet_renderer.h"
#include "server/render/rays_per_sample.h"

namespace framelet {

/// Fills a quarter of the samples of the tile that `child` is a child of: each is the mean of four of the child's, in
/// the display's light, as the viewer averages samples over a pixel. Depth, body, velocity and reflection are those of
/// the surface that most of the four show, the depth as the mean of those that show it. `will_be_moved`: the viewer
/// moves the samples; then what never moves gets no light of bodies before it, which would stay there when they have
/// gone. `geometry` and `display` are of that tile; body and velocity are allocated once a child has some. The samples
/// are finite for finite radiance.
void merge_child(Framelet const& child, DisplayTransform const& transform, bool will_be_moved, Framelet& geometry,
                 DisplayFramelet& display);

/// Renders one framelet on the calling thread. `geometry` gets all but the radiance; `scratch` is overwritten, and its
/// memory is reused. `rays_per_sample`: single_ray, or four_rays, which `merge_child` merges. Returns how many rays
/// that took, shadow and mirror rays included.
std::uint32_t render_display(RenderScene const& scene, ViewRays const& rays, ImagePlane const& plane, Tile tile,
                             DisplayTransform const& transform, int rays_per_sample, bool will_be_moved,
                             Framelet& scratch, Framelet& geometry, DisplayFramelet& display);

} // namespace framelet
