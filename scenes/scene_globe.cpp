#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"

namespace framelet {

GltfDocument make_globe_scene(GlobeParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.45, 0.80, 0.35});
    add_surroundings(document);
    add_meadow(document, 120);
    int const floor = document.add_material({.name = "floor",
                                             .base_color = D3(0.75, 0.72, 0.68),
                                             .roughness = 0.12,
                                             .base_color_texture = document.add_image(checker_texture())});
    int const bricks = document.add_material({.name = "bricks",
                                              .base_color = D3(0.80, 0.42, 0.30),
                                              .roughness = 0.9,
                                              .base_color_texture = document.add_image(brick_texture())});
    int const surface = document.add_material(
        {.name = "globe", .roughness = 0.2, .base_color_texture = document.add_image(globe_texture())});
    int const brass =
        document.add_material({.name = "brass", .base_color = D3(0.85, 0.63, 0.28), .metallic = 1, .roughness = 0.15});
    document.add_object("floor", make_ground({14, 9}, 1), floor, {{0, 0.03, 0}});
    document.add_object("wall", make_box({14, 2.2, 0.4}, 1.6), bricks, {{0, 1.1, -4.6}});

    int const traveller = document.add_node({.name = "traveller"});
    DQuat const tilt = rotation_about({0, 0, 1}, radians(-23.4));
    int const axis = document.add_node({.name = "axis", .place = {.rotation = tilt}}, traveller);
    int const globe = document.add_object("globe", make_sphere(parameters.radius, 64), surface, {}, axis);
    document.add_object("meridian", make_torus(parameters.radius * 1.12, 0.035, 64, 10), brass,
                        {.rotation = rotation_about({1, 0, 0}, pi / 2)}, axis);
    document.add_object("rod", make_cylinder(0.04, parameters.radius * 2.3, 12), brass,
                        {{0, -1.15 * parameters.radius, 0}}, axis);

    double const rate = 2 * pi / parameters.duration;
    document.tracks.push_back(translation_track(traveller, parameters.duration, 90, [&](double time) {
        return D3(parameters.travel.x * std::sin(rate * time), parameters.radius * 1.22,
                  parameters.travel.y * std::cos(rate * time) - 0.6);
    }));
    document.tracks.push_back(spin_track({globe}, {0, 1, 0}, 2 * pi * parameters.turns, parameters.duration));
    add_camera(document, {1.0, 2.6, 7.8}, {0, 1.2, -0.4}, 46);
    return document;
}

} // namespace framelet
