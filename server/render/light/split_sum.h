// Tabulates how much of uniform light the specular lobe reflects: the second factor of the split-sum approximation
// ([Karis 2013]) for the same GGX lobe that direct light uses.
#pragma once

#include <array>

#include "common/math.h"

namespace framelet {

class SplitSumTable {
public:
    SplitSumTable();

    /// Scale and bias: the lobe reflects f0 * x + y. x + y <= 1: what a perfect mirror of this roughness gives after
    /// one bounce off its facets.
    Vec2 at(float normal_view, float roughness) const;

private:
    static constexpr int side = 32;
    static constexpr std::size_t row = side;
    std::array<Vec2, row * row> values_;
};

/// Shares of environment light that a surface returns, from prefiltered radiance and from irradiance / pi. Light that
/// bounces more than once between facets is not lost but goes to the second share ([Fdez-Aguera 2019]), so a white
/// surface in a white furnace is white.
struct AmbientShares {
    Vec3 specular, diffuse;
};
AmbientShares ambient_shares(Vec2 split_sum, Vec3 const& f0, Vec3 const& diffuse);

} // namespace framelet
