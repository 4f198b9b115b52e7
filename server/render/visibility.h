// How far away what is to be seen is, and nothing else: rays through places of a picture, not shaded. In: scene, where
// to look from. Out: inverse depths, by which it is known what a viewer lacks.
#pragma once

#include <cstdint>
#include <vector>

#include "common/camera.h"
#include "server/render/prepared/render_scene.h"
#include "server/render/ray_grid.h"

namespace framelet {

/// Of a place where something see-through is seen, or something from its back: what counts there only shading tells.
inline constexpr float unknown_inverse_depth = -1;

/// Replaces `inverse_depth` by that of what each place shows, 1 / metres along the view, row by row; 0 where that is
/// the background. Returns how many rays that took. Parallel on the calling TBB arena.
std::uint64_t render_visibility(RenderScene const& scene, ViewRays const& view, Viewport viewport, RayGrid const& grid,
                                std::vector<float>& inverse_depth);

} // namespace framelet
