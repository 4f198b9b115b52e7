// The numbers of rays that a sample may be made of.
#pragma once

namespace framelet {

inline constexpr int single_ray = 1; ///< through the middle of its square of the tile
inline constexpr int four_rays = 4; ///< through the middles of the quarters of that square

} // namespace framelet
