// Punctual lights of the scene, hard or with a size, as paths sample them. In: a point of a surface. Out: one of the
// lights, chosen by what would arrive of each if nothing stood between; the directions that it fills.
#pragma once

#include <span>
#include <vector>

#include "server/render/light/light.h"
#include "server/render/path/path_options.h"

namespace framelet {

/// What one light sends to a point.
struct LampShine {
    Vec3 to_light; ///< unit, towards its middle
    float distance; ///< metres to its middle
    Vec3 arriving; ///< irradiance of a surface that faces it
    float sine; ///< of the angle of its radius; 0: hard
    float weight; ///< in proportion to its chance; 0: it cannot light a surface of this normal

    /// Solid angle, sr; for lights with a size.
    float angle() const;
    /// Radiance of a light with a size.
    Vec3 radiance() const;
    /// Metres along a unit direction until it meets a light with a size; infinite for suns, negative: it does not.
    float met_at(Vec3 const& direction) const;
};

/// One light's shine upon a point with this normal.
LampShine shine_of(RenderLight const& light, LampSizes sizes, Vec3 const& position, Vec3 const& normal);

/// All lights' shine upon a point with this normal; returns the sum of their weights.
float shine_of_lamps(std::span<RenderLight const> lights, LampSizes sizes, Vec3 const& position, Vec3 const& normal,
                     std::vector<LampShine>& out);

/// A unit direction within the cone that a light with a size fills.
Vec3 sample_lamp(LampShine const& lamp, Vec2 random);

} // namespace framelet
