// Procedural textures, as PNG files in memory. All but the flag repeat without a seam. Grey ones are tinted by the
// material.
#pragma once

#include <string>

namespace framelet {

/// A grey texture, mean about 0.7: stones of a few pixels, coarser stains.
std::string asphalt_texture();
/// A grey texture: short blades in all directions, light on dark.
std::string grass_texture();
/// A grey texture: two by two squares, light and dark.
std::string checker_texture();
/// A colour texture: one bay of a building, a window with a frame in plaster.
std::string facade_texture();
/// A grey texture: courses of bricks.
std::string brick_texture();
/// A grey texture: planks with grain, running along v.
std::string plank_texture();
/// A colour texture: clouds over a gradient from the horizon (lower edge) to 50 degrees; repeats sideways only.
std::string sky_texture();
/// A grey texture: slabs of stone, two by two, slightly different.
std::string slab_texture();
/// A colour texture, 2:1, equirectangular: land with detail at every scale, sea, ice, a graticule.
std::string globe_texture();
/// A colour texture: woven cloth, dark stripes across v on white, a thin line along v.
std::string stripe_texture();
/// A colour texture of a flag whose mast is at the left edge.
std::string flag_texture();
/// A texture of colour and coverage (alpha mask): a twig with leaves.
std::string leaf_texture();

} // namespace framelet
