#include "scenes/vehicle_scenes.h"

#include <cmath>

#include "scenes/gltf/animations.h"
#include "scenes/things/props.h"
#include "scenes/things/vehicle.h"

namespace framelet {
namespace {

/// Angle by which wheels roll, radians: distance / radius, rounded to a whole number of spokes so that the loop has no
/// jump.
double rolling_angle(double distance) {
    double const spoke = 2 * pi / wheel_spokes;
    return std::round(distance / wheel_radius / spoke) * spoke;
}

void add_hedge(GltfDocument& document) {
    int const tree = add_conifer_mesh(document, 5);
    for (int i = 0; i < 16; ++i) {
        D3 const foot(6.2 + 1.3 * random_unit(120, i), 0, -12.0 - 2.1 * i);
        document.add_node({.name = "hedge",
                           .place = {foot, rotation_about({0, 1, 0}, 6 * random_unit(121, i)),
                                     D3(6.0, 4.5 + 2 * random_unit(122, i), 6.0)},
                           .mesh = tree});
    }
}

} // namespace

GltfDocument make_vehicle_scene(VehicleShot const& shot) {
    GltfDocument document;
    add_sun(document, {0.50, 0.80, -0.28});
    int const hills = add_surroundings(document);
    add_roadside(document, shot.first_stretch, shot.last_stretch);
    if (shot.yard) {
        add_yard(document, {14, 0.03, 0}, {17, 48});
        add_hedge(document);
    }
    int first_car = no_index;
    for (Drive const& drive : shot.cars) {
        bool const backwards = drive.speed < 0;
        D3 const start(drive.lane_x, 0.02, drive.start_z);
        double const distance = drive.speed * shot.duration;
        Vehicle const car = add_vehicle(document, add_vehicle_meshes(document, drive.paint),
                                        {start, backwards ? rotation_about({0, 1, 0}, pi) : DQuat(1, 0, 0, 0), D3(1)});
        document.tracks.push_back(line_track(car.root, start, start + D3(0, 0, distance), shot.duration));
        document.tracks.push_back(spin_track({car.wheels.begin(), car.wheels.end()}, {1, 0, 0},
                                             rolling_angle(std::abs(distance)), shot.duration));
        first_car = first_car == no_index ? car.root : first_car;
    }
    bool const chase = shot.camera == CameraPath::chase;
    int const camera = add_camera(document, shot.eye, shot.target, shot.vertical_fov, chase ? first_car : no_index);
    if (chase) { // what is far away goes with the camera, so that the loop has no jump there either
        D3 const start = document.nodes[static_cast<std::size_t>(hills)].place.translation;
        D3 const along(0, 0, shot.cars.front().speed * shot.duration);
        document.tracks.push_back(line_track(hills, start, start + along, shot.duration));
    }
    if (shot.camera == CameraPath::pan) {
        Drive const& drive = shot.cars.front();
        auto const turned = [&](double time) {
            return looking_at(shot.eye, shot.target + D3(drive.lane_x, 0, drive.start_z + drive.speed * time));
        };
        document.tracks.push_back(rotation_track(camera, shot.duration, 150, turned));
    }
    return document;
}

} // namespace framelet
