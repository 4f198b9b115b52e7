// A car: smooth painted body, dark glass, lamps, wheels with spokes. It faces +Z, its left is +X, it stands on y = 0.
#pragma once

#include <array>

#include "scenes/gltf/gltf_document.h"
#include "scenes/things/vehicle_body.h"

namespace framelet {

/// A wheel looks the same after each turn by one of so many parts of a circle.
inline constexpr int wheel_spokes = 5;

/// Meshes of a car; several cars may share them.
struct VehicleMeshes {
    int body = 0;
    int wheel = 0;
};
VehicleMeshes add_vehicle_meshes(GltfDocument& document, D3 paint_color);

/// One car's nodes. Move `root`; turn `wheels` about their X axis (positive is forward).
struct Vehicle {
    int root = 0;
    std::array<int, 4> wheels{};
};
Vehicle add_vehicle(GltfDocument& document, VehicleMeshes const& meshes, Placement const& place = {});

} // namespace framelet
