// Measures how far away the visible surfaces are and nothing else, by rays through points of a picture that are not
// shaded. In: scene, the rays of a view, a grid of points. Out: inverse depths, which tell what a viewer lacks.
#pragma once

#include <cstdint>
#include <vector>

#include "common/camera.h"
#include "server/render/prepared/render_scene.h"
#include "server/render/ray_grid.h"

namespace framelet {

/// Inverse depth of a point where something see-through is seen, or the back of a single-sided surface: which depth
/// counts there only shading tells.
inline constexpr float unknown_inverse_depth = -1;

/// Replaces `inverse_depth` by that of the surface that each point shows, 1 / metres along the view, row by row; 0
/// where that is the background. Returns how many rays that took. Parallel on the calling TBB arena.
std::uint64_t render_visibility(RenderScene const& scene, ViewRays const& view, Viewport viewport, RayGrid const& grid,
                                std::vector<float>& inverse_depth);

} // namespace framelet
