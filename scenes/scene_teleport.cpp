#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/things/landscape.h"
#include "scenes/things/vehicle.h"

namespace framelet {

GltfDocument make_teleport_scene(TeleportParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {0.50, 0.80, -0.28});
    add_surroundings(document);
    add_roadside(document, -3, 3);
    VehicleMeshes const red = add_vehicle_meshes(document, {0.55, 0.02, 0.02});
    VehicleMeshes const blue = add_vehicle_meshes(document, {0.02, 0.09, 0.42});
    add_vehicle(document, red, {{near_lane_x, 0.02, 3}});
    add_vehicle(document, blue, {{far_lane_x, 0.02, -14}, rotation_about({0, 1, 0}, pi), D3(1)});
    add_vehicle(document, red, {{far_lane_x, 0.02, 32}, rotation_about({0, 1, 0}, pi), D3(1)});
    int const camera = add_camera(document, {0, 0, 0}, {0, 0, -1}, 45);
    std::vector<D4> eyes;
    std::vector<D4> turns;
    for (TeleportParameters::View const& view : parameters.views) {
        eyes.push_back(D4(view.eye, 0));
        turns.push_back(as_key(looking_at(view.eye, view.target)));
    }
    document.tracks.push_back(step_track(camera, GltfPath::translation, parameters.duration, eyes));
    document.tracks.push_back(step_track(camera, GltfPath::rotation, parameters.duration, turns));
    return document;
}

} // namespace framelet
