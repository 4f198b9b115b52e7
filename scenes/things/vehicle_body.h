// The car's body as a surface that is lofted along Z through rounded cross-sections, split by material.
#pragma once

#include "scenes/mesh/geometry.h"

namespace framelet {

/// Measures of the wheels, which fit the body's arches, in metres.
inline constexpr double wheel_radius = 0.34;
inline constexpr double front_axle_z = 1.35;
inline constexpr double rear_axle_z = -1.32;

struct VehicleBody {
    MeshData paint, glass, trim, head_lamps, tail_lamps, plate;
};

/// Makes a body that faces +Z and stands on y = 0; wheel arches are cut where the axles are.
VehicleBody make_vehicle_body();

} // namespace framelet
