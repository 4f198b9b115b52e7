// The five vehicle animations of [Stephens 2011] section 7.1.1.1: one world, one car (or two), different cameras.
#pragma once

#include "scenes/gltf/gltf_document.h"
#include "scenes/things/landscape.h"

namespace framelet {

/// A car on the straight road: at constant speed along +Z (negative speed: facing and driving along -Z).
struct Drive {
    double lane_x = near_lane_x; ///< metres
    double start_z = 0; ///< metres, at time 0
    double speed = 24; ///< metres a second
    D3 paint{0.55, 0.02, 0.02}; ///< linear
};

enum class CameraPath {
    fixed, ///< stands and looks at `target`
    chase, ///< `eye` and `target` are relative to the first car, and go with it
    pan, ///< stands, turns to keep the first car (its `target` point) in the middle
};

struct VehicleShot {
    double duration = 5; ///< seconds
    std::vector<Drive> cars{};
    CameraPath camera = CameraPath::fixed;
    D3 eye{0}, target{0}; ///< metres, in the frame that `camera` says
    double vertical_fov = 40; ///< degrees
    int first_stretch = -2, last_stretch = 2; ///< of road, landscape.h
    bool yard = false; ///< a paved yard with a hedge beside the road
};

GltfDocument make_vehicle_scene(VehicleShot const& shot);

} // namespace framelet
