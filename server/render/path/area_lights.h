// Emissive triangles as lights. In: a scene in its present pose. Out: points on them, by area and luminance, and how
// densely these lie. Only emissive geometry is looked at, and a scene without has an empty table.
#pragma once

#include <vector>

#include "server/render/prepared/prepared_scene.h"

namespace framelet {

struct LightPoint {
    Vec3 position; ///< world, metres
    Vec3 normal; ///< unit, of the side that is lit; both sides are where `both`
    bool both;
    Vec3 radiance; ///< alpha included; black where the surface is cut out
    float density; ///< 1 / m^2
};

class AreaLights {
public:
    explicit AreaLights(PreparedScene const& scene);

    bool empty() const { return triangles_.empty(); }
    LightPoint sample(float choice, Vec2 random) const;
    /// Density with which `sample` finds each point of a triangle, 1 / m^2; the same for every instance of it.
    float density(Geometry const& geometry, std::uint32_t triangle) const;

private:
    struct Triangle {
        Instance const* instance;
        Geometry const* geometry;
        std::uint32_t number;
    };
    std::vector<Triangle> triangles_;
    std::vector<float> up_to_; ///< sums of area * luminance as shares of the total; the last is 1
    double total_ = 0; ///< sum of area * luminance
};

} // namespace framelet
