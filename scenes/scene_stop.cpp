#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"
#include "scenes/things/props.h"
#include "scenes/things/vehicle.h"

namespace framelet {
namespace {

constexpr double ring_radius = 3.4; // metres, of the car's circle

/// Keeps the last value until `duration`.
GltfTrack held(GltfTrack track, double duration) {
    track.times.push_back(duration);
    track.values.push_back(track.values.back());
    return track;
}

} // namespace

GltfDocument make_stop_scene(StopParameters const& parameters) {
    GltfDocument document;
    double const moving = parameters.moving;
    double const rate = 2 * pi / moving; // every motion is back where it began when it stops, so the loop has no jump
    auto const add_motion = [&](GltfTrack track) {
        document.tracks.push_back(held(std::move(track), parameters.duration));
    };
    add_sun(document, {0.40, 0.80, 0.42});
    add_surroundings(document);
    add_meadow(document, 120);
    add_yard(document, {0, 0.03, 0}, {20, 20});
    int const house = add_house_mesh(document, 5, 2, 2);
    document.add_node({.name = "house", .place = {{0, 0, -17}}, .mesh = house});
    int const red = document.add_material({.name = "red", .base_color = D3(0.7, 0.08, 0.05), .roughness = 0.3});
    int const chrome =
        document.add_material({.name = "chrome", .base_color = D3(0.9), .metallic = 1, .roughness = 0.05});
    int const checker = document.add_material(
        {.name = "checker", .roughness = 0.5, .base_color_texture = document.add_image(checker_texture())});

    Vehicle const car = add_vehicle(document, add_vehicle_meshes(document, {0.03, 0.12, 0.45}));
    add_motion(translation_track(car.root, moving, 90, [&](double time) {
        return D3(ring_radius * std::cos(rate * time), 0.03, -ring_radius * std::sin(rate * time));
    }));
    add_motion(rotation_track(car.root, moving, 90, [&](double time) {
        return rotation_about({0, 1, 0}, pi + rate * time);
    }));
    double const turns = std::round(ring_radius / wheel_radius);
    add_motion(spin_track({car.wheels.begin(), car.wheels.end()}, {1, 0, 0}, 2 * pi * turns, moving));

    int const cube = document.add_object("cube", make_rounded_box(D3(1.3), 0.08), red, {{0, 1.6, 0}});
    add_motion(spin_track({cube}, glm::normalize(D3(1, 2, 1)), 4 * pi, moving));
    int const drum = document.add_object("drum", make_cylinder(0.8, 1.6, 32), checker, {{-6.5, 0.1, -3.5}});
    add_motion(spin_track({drum}, {0, 1, 0}, 6 * pi, moving));
    for (int i = 0; i < 5; ++i) {
        D3 const place(-4.0 + 2.0 * i, 0, -6.8);
        int const ball = document.add_object("ball", make_sphere(0.5, 32), i % 2 == 0 ? chrome : red);
        add_motion(translation_track(ball, moving, 120, [&](double time) { // three bounces, one after the other
            double const phase = std::fmod(3 * time / moving + 0.2 * i, 1.0);
            return place + D3(0, 0.53 + 10 * phase * (1 - phase), 0);
        }));
    }
    int const camera = add_camera(document, {0, 0, 0}, {0, 0, -1}, 48);
    auto const eye = [&](double time) {
        return D3(2.5 + 2.2 * std::sin(rate * time), 3.4 + 0.5 * std::sin(2 * rate * time), 12.5);
    };
    add_motion(translation_track(camera, moving, 90, eye));
    add_motion(rotation_track(camera, moving, 90, [&](double time) { return looking_at(eye(time), {0, 1.2, -1}); }));
    return document;
}

} // namespace framelet
