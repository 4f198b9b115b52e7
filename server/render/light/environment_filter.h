// Filters equirectangular maps: halving levels, irradiance, GGX lobes. In: radiance by direction. Out: the same,
// averaged. Every filter's weights sum to 1, so that uniform radiance stays what it is.
#pragma once

#include "common/image.h"
#include "server/render/light/octahedral_map.h"

namespace framelet {

/// Point of an equirectangular map, [0,1]^2, for a direction, and back (environment.h states the mapping).
Vec2 equirect_from_direction(Vec3 const& direction);
Vec3 direction_from_equirect(Vec2 point);
/// The direction of the middle of a texel.
Vec3 direction_of_texel(FloatImage const& map, int x, int y);

/// Bilinear look-up; wraps around in u.
Vec3 sample_equirect(FloatImage const& map, Vec2 point);

/// The map itself and halvings of it down to a few texels; rows weigh as much as their solid angle.
std::vector<FloatImage> equirect_levels(FloatImage const& map);

/// The finest level that has at most `width` texels a row, else the coarsest.
FloatImage const& level_of_width(std::vector<FloatImage> const& levels, int width);

/// Irradiance / pi for every direction: the whole sphere is summed, so a small bright sun is neither lost nor noise.
OctahedralMap filter_diffuse(std::vector<FloatImage> const& levels, int side);

/// Radiance averaged over the GGX lobe of a perceptual roughness > 0 whose mirror direction, normal and view coincide
/// ([Karis 2013]). Importance samples read the level whose texels are as wide as the gap between samples
/// ([Krivanek 2008]): smooth without random numbers.
OctahedralMap filter_specular(std::vector<FloatImage> const& levels, float roughness, int side);

} // namespace framelet
