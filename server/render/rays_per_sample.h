// The numbers of rays that a sample may be made of: paths of light, or rays of direct light.
#pragma once

#include <algorithm>
#include <bit>

namespace framelet {

inline constexpr int single_ray = 1; ///< through the middle of its square of the tile; a path: through any point of it
inline constexpr int four_rays = 4; ///< through the middles of the quarters of that square
inline constexpr int most_rays_at_once = 16; ///< so few that a batch of them does not keep a camera waiting

/// How many a sample of so many is made of next, where these are not enough of a picture at rest.
constexpr int next_rays(int rays_per_sample) {
    return rays_per_sample < most_rays_at_once ? four_rays * rays_per_sample : rays_per_sample + most_rays_at_once;
}
/// How many of them are new, at most.
constexpr int new_rays(int rays_per_sample) {
    return std::min(rays_per_sample, most_rays_at_once);
}
/// True where a viewer is sent what so many make: each time they are twice as many, what is left of their noise is
/// worth its bytes.
constexpr bool are_shown(int rays_per_sample) {
    return std::has_single_bit(static_cast<unsigned>(rays_per_sample));
}

} // namespace framelet
