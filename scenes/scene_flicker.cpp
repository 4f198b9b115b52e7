#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"
#include "scenes/things/vehicle.h"

namespace framelet {
namespace {

constexpr D3 room{8, 3.2, 9}; // metres

void add_room(GltfDocument& document) {
    int const bricks = document.add_material({.name = "bricks",
                                              .base_color = D3(0.85, 0.62, 0.50),
                                              .roughness = 0.9,
                                              .base_color_texture = document.add_image(brick_texture())});
    int const floor = document.add_material({.name = "floor",
                                             .base_color = D3(0.6),
                                             .roughness = 0.25,
                                             .base_color_texture = document.add_image(slab_texture())});
    int const ceiling = document.add_material({.name = "ceiling", .base_color = D3(0.7), .roughness = 0.9});
    document.add_object("floor", make_box({room.x + 0.6, 0.2, room.z + 0.6}, 2), floor, {{0, -0.1, 0}});
    document.add_object("ceiling", make_box({room.x + 0.6, 0.2, room.z + 0.6}), ceiling, {{0, room.y + 0.1, 0}});
    MeshData walls;
    for (double const side : {-1.0, 1.0}) {
        append(walls, make_box({0.3, room.y, room.z}, 1.4), {{side * (room.x / 2 + 0.15), room.y / 2, 0}});
        append(walls, make_box({room.x + 0.6, room.y, 0.3}, 1.4), {{0, room.y / 2, side * (room.z / 2 + 0.15)}});
    }
    document.add_object("walls", std::move(walls), bricks);
}

void add_shelf(GltfDocument& document, D3 place) {
    int const wood = document.add_material({.name = "boards",
                                            .base_color = D3(0.75, 0.55, 0.34),
                                            .roughness = 0.7,
                                            .base_color_texture = document.add_image(plank_texture())});
    int const tin = document.add_material({.name = "tin", .base_color = D3(0.75), .metallic = 0.9, .roughness = 0.25});
    int const card = document.add_material({.name = "cardboard", .base_color = D3(0.42, 0.29, 0.17), .roughness = 0.9});
    MeshData boards;
    MeshData boxes;
    MeshData tins;
    for (int board = 0; board < 4; ++board) {
        double const y = 0.25 + 0.65 * board;
        append(boards, make_box({3.2, 0.05, 0.5}, 0.8), {{0, y, 0}});
        for (int item = 0; item < 7; ++item) {
            auto const random = [&](int what) { return random_unit(300, board, item, what); };
            D3 const foot(-1.4 + 0.45 * item, y + 0.025, 0.1 * (random(0) - 0.5));
            double const height = 0.18 + 0.3 * random(1);
            if (random(2) < 0.5) {
                append(tins, make_cylinder(0.08 + 0.06 * random(3), height, 20), {foot});
            } else {
                append(boxes, make_rounded_box({0.34, height, 0.3}, 0.01), {foot + D3(0, height / 2, 0)});
            }
        }
    }
    for (double const x : {-1.6, 1.6}) {
        append(boards, make_box({0.06, 2.6, 0.5}, 0.8), {{x, 1.3, 0}});
    }
    document.add_object("shelf", std::move(boards), wood, {place});
    document.add_object("boxes", std::move(boxes), card, {place});
    document.add_object("tins", std::move(tins), tin, {place});
}

} // namespace

GltfDocument make_flicker_scene(FlickerParameters const& parameters) {
    GltfDocument document;
    add_room(document);
    add_shelf(document, {-1.4, 0, -4.2});
    add_vehicle(document, add_vehicle_meshes(document, {0.30, 0.32, 0.34}),
                {{0.9, 0, -0.6}, rotation_about({0, 1, 0}, radians(-28)), D3(1)});
    int const tyre_like = document.add_material({.name = "old rubber", .base_color = D3(0.04), .roughness = 0.8});
    for (int i = 0; i < 3; ++i) {
        document.add_object("old tyre", make_torus(0.26, 0.11, 32, 12), tyre_like, {{-3.2, 0.11 + 0.21 * i, -1.6}});
    }
    int const glow = document.add_material({.name = "glow", .base_color = D3(0.8), .emissive = D3(9, 8.4, 7)});
    int const shade = document.add_material(
        {.name = "shade", .base_color = D3(0.03, 0.10, 0.05), .roughness = 0.3, .double_sided = true});

    D3 const lamp_place(-0.6, 2.55, 0.4);
    document.add_object("shade", make_cone(0.34, 0.26, 28), shade, {lamp_place + D3(0, 0.04, 0)});
    document.add_object("cord", make_cylinder(0.012, 0.4, 8), shade, {lamp_place + D3(0, 0.28, 0)});
    document.lights.push_back({"point", {1.0, 0.92, 0.78}, parameters.lamp_candela});
    document.lights.push_back({"point", {0.75, 0.85, 1.0}, parameters.other_candela});
    int const lamp = document.add_node({.name = "lamp", .place = {lamp_place}});
    document.add_node({.name = "lamp light", .place = {{0, -0.14, 0}}, .light = 0}, lamp);
    document.add_object("bulb", make_sphere(0.07, 16), glow, {}, lamp);
    document.add_node({.name = "night light", .place = {{3.6, 2.4, 3.4}}, .light = 1});
    std::vector<D4> places;
    for (bool const lit : parameters.lit) {
        places.push_back(D4(lit ? lamp_place : lamp_place + D3(0, room.y, 0), 0));
    }
    document.tracks.push_back(step_track(lamp, GltfPath::translation, parameters.duration, places));
    add_camera(document, {-3.3, 1.7, 3.9}, {0.3, 0.95, -1.2}, 56);
    return document;
}

} // namespace framelet
