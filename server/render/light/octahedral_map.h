// A function of direction in a square picture (octahedral mapping, [Cigolle 2014]). Look-ups need no trigonometry and
// no case for the poles.
#pragma once

#include <vector>

#include "common/math.h"

namespace framelet {

/// Point of [0,1]^2 for a direction (of any length) and back. +Y is the middle, -Y the four corners.
Vec2 octahedral_from_direction(Vec3 const& direction);
Vec3 direction_from_octahedral(Vec2 point);

class OctahedralMap {
public:
    OctahedralMap() = default;
    /// Makes the map of `values`: side * side, rows from v = 0, texel centres at (i + 0.5) / side.
    OctahedralMap(int side, std::vector<Vec3> const& values);

    Vec3 sample(Vec3 const& direction) const { return sample_at(octahedral_from_direction(direction)); }
    Vec3 sample_at(Vec2 point) const;

private:
    int side_ = 0;
    std::vector<Vec4> texels_; // (side + 2)^2: a border of one texel holds what lies across the edges
};

/// Texel centres' directions, in the order of `values` above.
std::vector<Vec3> octahedral_directions(int side);

} // namespace framelet
