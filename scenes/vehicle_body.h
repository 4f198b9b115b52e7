// The car's body as a surface that is lofted along Z through rounded cross-sections, split by material.
#pragma once

#include "scenes/geometry.h"

namespace framelet {

struct VehicleBody {
    MeshData paint, glass, trim, head_lamps, tail_lamps, plate;
};

/// Faces +Z, stands on y = 0; wheel arches are cut where vehicle.h puts the axles.
VehicleBody make_vehicle_body();

} // namespace framelet
