// Renders framelets, single samples and whole pictures. In: a prepared scene, a camera, tiles or positions. Out:
// samples.
#pragma once

#include <cstdint>
#include <span>

#include "common/color.h"
#include "common/framelet/framelet.h"
#include "server/render/prepared/render_scene.h"
#include "server/render/probe.h"

namespace framelet {

/// Renders one framelet per tile into `out` (same length), in parallel over framelets on the calling TBB arena. Each
/// sample is a ray through the middle of its square of the tile. The result depends on scene, view and tile alone, not
/// on threads or on the other tiles. Returns how many rays that took, shadow and mirror rays included.
std::uint64_t render_framelets(RenderScene const& scene, Camera const& camera, ImagePlane const& plane,
                               std::span<Tile const> tiles, std::span<Framelet> out);

/// Renders one framelet as `render_framelets` does, on the calling thread. `rays` are of the plane's viewport. Returns
/// how many rays that took.
std::uint32_t render_framelet(RenderScene const& scene, ViewRays const& rays, ImagePlane const& plane, Tile tile,
                              Framelet& out);

/// Renders scene-linear radiance at any positions of the image plane (pixels), each of a footprint of its own of
/// `spacings` (pixels), into `radiance` (all of the same length). Positions that follow each other are traced together:
/// neighbours are cheaper. `light`: as long, or empty. Parallel on the calling TBB arena; returns how many rays that
/// took.
std::uint64_t render_samples(RenderScene const& scene, ViewRays const& rays, std::span<Vec2 const> positions,
                             std::span<float const> spacings, std::span<Vec3> radiance,
                             std::span<SampleLight> light = {});

/// Renders the whole picture by the same renderer without tiling, wire or cache: `samples_per_side`^2 samples a pixel
/// on the same grid that framelets use, each tone-mapped and quantised as `to_display` does, then averaged in linear
/// light (box filter). `samples_per_side`: 1, 2, 4 or 8.
Picture render_picture(RenderScene const& scene, Camera const& camera, Viewport viewport,
                       DisplayTransform const& transform, int samples_per_side);

} // namespace framelet
