// Turns polygons into triangles, by ear clipping. Unlike Assimp's it never leaves a hole: polygons that are not simple
// get all of their n - 2 triangles too. In: the corners in order. Out: indices of corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/math.h"

namespace framelet {

/// Makes exactly n - 2 triangles, wound like the polygon; none for fewer than three corners. The polygon should be
/// about flat and may be concave. Where no ear is left (it crosses itself), and beyond `max_clipped_corners`, the rest
/// is a fan.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<Vec3 const> corners);

/// Most corners of a polygon that is clipped: ear clipping takes cubic time in the worst case.
inline constexpr std::size_t max_clipped_corners = 256;

} // namespace framelet
