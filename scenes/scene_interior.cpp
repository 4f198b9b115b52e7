#include <array>
#include <cmath>

#include "scenes/gltf/animations.h"
#include "scenes/lit_scenes.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/furniture.h"
#include "scenes/things/landscape.h"
#include "scenes/things/props.h"

namespace framelet {
namespace {

constexpr D3 room{6.0, 2.8, 5.0}; // metres
constexpr double thickness = 0.24; // of walls
constexpr double hall_width = 1.5;

/// A rectangle in a wall, from its lower left corner.
struct Opening {
    D2 low, high;
};
constexpr Opening window{{-0.9, 0.85}, {1.1, 2.25}}; // in the wall behind: x, y
constexpr Opening doorway{{0.3, 0}, {1.25, 2.1}}; // in the wall to the left: z, y

/// A wall in the XY plane about z = 0, from `low` to `high`, with an opening.
MeshData make_wall(D2 low, D2 high, Opening const& opening, double texture_size) {
    MeshData wall;
    auto const add = [&](D2 from, D2 to) {
        if (to.x > from.x && to.y > from.y) {
            append(wall, make_box({to.x - from.x, to.y - from.y, thickness}, texture_size),
                   {{(from.x + to.x) / 2, (from.y + to.y) / 2, 0}});
        }
    };
    add(low, {opening.low.x, high.y});
    add({opening.high.x, low.y}, high);
    add({opening.low.x, low.y}, {opening.high.x, opening.low.y});
    add({opening.low.x, opening.high.y}, {opening.high.x, high.y});
    return wall;
}

/// The frame of an opening in the XY plane, its lower left corner at the origin.
MeshData make_frame(D2 size, double width, double depth, bool has_sill) {
    MeshData frame;
    for (double const x : {0.0, size.x}) {
        append(frame, make_box({width, size.y + width, depth}, 0.5), {{x, size.y / 2, 0}});
    }
    append(frame, make_box({size.x + width, width, depth}, 0.5), {{size.x / 2, size.y, 0}});
    if (has_sill) {
        append(frame, make_box({size.x + 4 * width, width, depth + 0.16}, 0.5), {{size.x / 2, 0, 0.08}});
    }
    return frame;
}

void add_walls(GltfDocument& document, RoomMaterials const& materials) {
    int const white = document.add_material({.name = "white", .base_color = D3(0.78, 0.76, 0.71), .roughness = 0.9});
    int const red = document.add_material({.name = "red wall", .base_color = D3(0.62, 0.16, 0.10), .roughness = 0.9});
    D2 const outer(room.x / 2 + thickness, room.y);
    double const left = -room.x / 2 - thickness / 2, back = -room.z / 2 - thickness / 2;
    document.add_object("floor", make_box({room.x + 2 * thickness, 0.2, room.z + 2 * thickness}, 1.2), materials.boards,
                        {{0, -0.1, 0}});
    MeshData lids = make_box({room.x + 2 * thickness, 0.2, room.z + 2 * thickness});
    document.add_object("ceiling", std::move(lids), white, {{0, room.y + 0.1, 0}});
    document.add_object("window wall", make_wall({-outer.x, 0}, outer, window, 0), white, {{0, 0, back}});
    document.add_object("front wall", make_box({2 * outer.x, room.y, thickness}), white, {{0, room.y / 2, -back}});
    document.add_object("right wall", make_box({thickness, room.y, room.z}), red, {{-left, room.y / 2, 0}});
    // Turned by a quarter, so that the wall's x is the room's -z.
    Opening const turned{{-doorway.high.x, doorway.low.y}, {-doorway.low.x, doorway.high.y}};
    Placement const on_left{{left, 0, 0}, rotation_about({0, 1, 0}, pi / 2), D3(1)};
    document.add_object("door wall", make_wall({-room.z / 2, 0}, {room.z / 2, room.y}, turned, 0), white, on_left);
    int const paint = document.add_material({.name = "white paint", .base_color = D3(0.80), .roughness = 0.4});
    D2 const pane = window.high - window.low;
    MeshData frame = make_frame(pane, 0.07, thickness + 0.02, true);
    append(frame, make_box({0.05, pane.y, 0.06}, 0.5), {{pane.x / 2, pane.y / 2, 0}});
    append(frame, make_box({pane.x, 0.04, 0.05}, 0.5), {{pane.x / 2, 0.7 * pane.y, 0}});
    document.add_object("window frame", std::move(frame), paint, {{window.low.x, window.low.y, back}});
    document.add_object("door frame", make_frame(doorway.high - doorway.low, 0.07, thickness + 0.02, false), paint,
                        {{left, 0, doorway.high.x}, on_left.rotation, D3(1)});
}

/// The hall behind the door, which has a lamp of its own.
void add_hall(GltfDocument& document, RoomMaterials const& materials) {
    int const ochre = document.add_material({.name = "ochre", .base_color = D3(0.72, 0.50, 0.20), .roughness = 0.9});
    D3 const middle(-room.x / 2 - thickness - hall_width / 2, 0, 0.6);
    double const length = 3.4;
    MeshData shell;
    append(shell, make_box({hall_width + 2 * thickness, 0.2, length}),
           {middle + D3(0, -0.102, 0)}); // below the boards in the doorway
    append(shell, make_box({hall_width + 2 * thickness, 0.2, length}), {middle + D3(0, room.y + 0.102, 0)});
    append(shell, make_box({thickness, room.y, length}), {middle + D3(-(hall_width + thickness) / 2, room.y / 2, 0)});
    for (double const side : {-1.0, 1.0}) {
        append(shell, make_box({hall_width + 2 * thickness, room.y, thickness}),
               {middle + D3(0, room.y / 2, side * (length + thickness) / 2)});
    }
    document.add_object("hall", std::move(shell), ochre);
    add_lamp(document, materials, middle + D3(0, room.y - 0.25, -0.2), {1.0, 0.80, 0.55}, 9);
}

/// The door, which opens into the hall and closes again.
void add_door(GltfDocument& document, RoomMaterials const& materials, InteriorParameters const& parameters) {
    D2 const size = doorway.high - doorway.low - D2(0.02, 0.01);
    MeshData leaf;
    append(leaf, make_box({0.045, size.y, size.x}, 0.7), {{0, size.y / 2, size.x / 2}});
    for (double const y : {0.25 * size.y, 0.72 * size.y}) {
        append(leaf, make_box({0.06, 0.38 * size.y, 0.62 * size.x}, 0.7), {{0, y, size.x / 2}});
    }
    MeshData handle = make_sphere(0.035, 12);
    append(handle, make_sphere(0.035, 12), {{-0.13, 0, 0}});
    D3 const hinge(-room.x / 2 - thickness / 2, 0.005, doorway.low.x + 0.01);
    int const door = document.add_node({.name = "door", .place = {hinge}});
    document.add_object("door leaf", std::move(leaf), materials.wood, {}, door);
    document.add_object("handle", std::move(handle), materials.brass, {{0.065, 1.02, size.x - 0.08}}, door);
    double const angle = radians(parameters.door_degrees);
    document.tracks.push_back(rotation_track(door, parameters.duration, 64, [&](double seconds) {
        double const part = seconds / parameters.duration;
        double const open = smooth_step((part - 0.1) / 0.3) - smooth_step((part - 0.65) / 0.3);
        return rotation_about({0, 1, 0}, -angle * open);
    }));
}

/// A standing lamp whose shade lets its light out above and below, and glows.
void add_standing_lamp(GltfDocument& document, RoomMaterials const& materials, D3 foot) {
    int const shade = document.add_material({.name = "lamp shade",
                                             .base_color = D3(0.80, 0.70, 0.52),
                                             .emissive = D3(1.5, 1.05, 0.55),
                                             .double_sided = true});
    std::array<D2, 4> const stand{D2(0.15, 0), D2(0.15, 0.02), D2(0.014, 0.04), D2(0.014, 1.42)};
    document.add_object("lamp stand", make_lathe(stand, 24), materials.brass, {foot});
    document.add_object("lamp shade", make_lathe(std::array<D2, 2>{D2(0.23, 1.32), D2(0.14, 1.62)}, 32), shade, {foot});
    document.lights.push_back({"point", {1.0, 0.78, 0.50}, 7});
    document.add_node(
        {.name = "lamp light", .place = {foot + D3(0, 1.5, 0)}, .light = static_cast<int>(document.lights.size()) - 1});
}

} // namespace

GltfDocument make_interior_scene(InteriorParameters const& parameters) {
    GltfDocument document;
    document.light = "full";
    add_sun(document, {0.30, 0.86, -0.52});
    document.lights.front().intensity *= 3; // beside which lamps are dim
    add_surroundings(document);
    add_meadow(document, 120);
    int const tree = add_broadleaf_mesh(document, 3);
    for (auto const& [x, z] : {std::pair(-3.5, -14.0), {1.2, -11.0}, {5.0, -17.0}}) {
        document.add_node({.name = "tree", .place = {{x, -0.2, z}, DQuat(1, 0, 0, 0), D3(6)}, .mesh = tree});
    }
    RoomMaterials const materials = add_room_materials(document);
    add_walls(document, materials);
    add_hall(document, materials);
    add_door(document, materials, parameters);
    document.add_object("rug", make_ground({2.6, 1.9}, 0.4), materials.rug, {{-0.2, 0.01, -0.3}});
    D3 const table(-0.3, 0.01, -0.5);
    add_table(document, materials, table);
    int const chair = add_chair_mesh(document, materials);
    for (double const angle : {0.2, 2.9}) {
        DQuat const turned = rotation_about({0, 1, 0}, angle);
        document.add_node({.name = "chair", .place = {table + turned * D3(0, 0, -0.85), turned}, .mesh = chair});
    }
    add_book_shelf(document, materials, {-2.1, 0, -room.z / 2 + 0.15});
    add_sofa(document, materials, {{room.x / 2 - 0.5, 0, -0.6}, rotation_about({0, 1, 0}, -pi / 2), D3(1)});
    add_standing_lamp(document, materials, {-2.55, 0, -1.1});
    int const fern = add_broadleaf_mesh(document, 8);
    document.add_object("pot",
                        make_lathe(std::array<D2, 4>{D2(0.11, 0), D2(0.17, 0.3), D2(0.15, 0.3), D2(0, 0.26)}, 24),
                        materials.china, {{1.75, 0, -2.1}});
    document.add_node({.name = "plant", .place = {{1.75, 0.2, -2.1}, DQuat(1, 0, 0, 0), D3(1.1)}, .mesh = fern});

    D3 const eye(1.7, 1.6, 2.2);
    D3 const target(-1.0, 1.05, -0.9);
    add_drifting_camera(document, eye, target, 60, parameters.drift, parameters.duration);
    return document;
}

} // namespace framelet
