#include <array>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/things/furniture.h"
#include "scenes/things/landscape.h"

namespace framelet {
namespace {

constexpr D3 room{6.4, 3.2, 5.6}; // metres
constexpr D3 fan_place{-0.4, 2.42, -0.5}; // of the blades

void add_room(GltfDocument& document, RoomMaterials const& materials) {
    document.add_object("floor", make_box({room.x, 0.2, room.z}, 1.2), materials.boards, {{0, -0.1, 0}});
    document.add_object("ceiling", make_box({room.x, 0.2, room.z}), materials.plaster, {{0, room.y + 0.1, 0}});
    MeshData bricks;
    MeshData plaster;
    for (double const side : {-1.0, 1.0}) {
        append(bricks, make_box({room.x, room.y, 0.2}, 1.3), {{0, room.y / 2, side * (room.z / 2 + 0.1)}});
        append(plaster, make_box({0.2, room.y, room.z}), {{side * (room.x / 2 + 0.1), room.y / 2, 0}});
    }
    document.add_object("brick walls", std::move(bricks), materials.bricks);
    document.add_object("side walls", std::move(plaster), materials.plaster);
    document.add_object("rug", make_ground({3.2, 2.2}, 0.4), materials.rug, {{-0.4, 0.01, -0.4}});
    add_framed_map(document, materials, {0.5, 1.45, -room.z / 2 + 0.02});
}

/// Adds the fan on its rod; returns the node that turns.
int add_fan(GltfDocument& document, RoomMaterials const& materials, int blades) {
    double const rod = room.y - fan_place.y;
    std::array<D2, 6> const housing{D2(0, -0.10),   D2(0.07, -0.09), D2(0.11, -0.03),
                                    D2(0.11, 0.04), D2(0.05, 0.09),  D2(0.018, 0.10)};
    MeshData still = make_lathe(housing, 32);
    append(still, make_cylinder(0.018, rod, 12));
    append(still, make_cone(0.08, 0.07, 24), {{0, rod, 0}, rotation_about({1, 0, 0}, pi), {1, 1, 1}});
    document.add_object("fan", std::move(still), materials.brass, {fan_place});
    MeshData wood;
    MeshData brackets;
    for (int blade = 0; blade < blades; ++blade) {
        DQuat const turned = rotation_about({0, 1, 0}, 2 * pi * blade / blades);
        DQuat const pitched = turned * rotation_about({1, 0, 0}, radians(13));
        append(wood, make_box({0.72, 0.012, 0.17}, 0.4), {turned * D3(0.56, 0, 0), pitched, {1, 1, 1}});
        append(brackets, make_box({0.16, 0.014, 0.04}), {turned * D3(0.17, 0, 0), turned, {1, 1, 1}});
    }
    int const rotor = document.add_node({.name = "rotor",
                                         .place = {fan_place},
                                         .mesh = document.add_mesh("rotor", {{std::move(wood), materials.boards},
                                                                             {std::move(brackets), materials.brass}})});
    return rotor;
}

} // namespace

GltfDocument make_fan_scene(FanParameters const& parameters) {
    GltfDocument document;
    RoomMaterials const materials = add_room_materials(document);
    add_room(document, materials);
    D3 const table(-0.4, 0.01, -0.5);
    add_table(document, materials, table);
    int const chair = add_chair_mesh(document, materials);
    for (int i = 0; i < 3; ++i) {
        double const angle = std::array{0.15, 1.75, -1.4}.at(static_cast<std::size_t>(i));
        DQuat const turned = rotation_about({0, 1, 0}, angle);
        document.add_node(
            {.name = "chair", .place = {table + turned * D3(0, 0, i == 0 ? -0.72 : -1.02), turned}, .mesh = chair});
    }
    add_book_shelf(document, materials, {-2.1, 0, -room.z / 2 + 0.15});
    add_sofa(document, materials, {{-room.x / 2 + 0.5, 0, 0.4}, rotation_about({0, 1, 0}, pi / 2), {1, 1, 1}});

    int const rotor = add_fan(document, materials, parameters.blades);
    document.tracks.push_back(spin_track({rotor}, {0, 1, 0}, -2 * pi * parameters.turns, parameters.duration));
    add_lamp(document, materials, {0.15, room.y - 0.17, -0.2}, {1.0, 0.90, 0.74}, 19);
    add_lamp(document, materials, {2.2, room.y - 0.45, -1.9}, {1.0, 0.94, 0.84}, 6);
    document.add_object("cord", make_cylinder(0.008, 0.3, 8), materials.brass, {{2.2, room.y - 0.3, -1.9}});
    document.lights.push_back({"point", {0.75, 0.85, 1.0}, 2.5}); // dusk, behind the camera
    document.add_node({.name = "dusk", .place = {{2.9, 1.3, 2.5}}, .light = 2});

    D3 const eye(2.65, 1.65, 2.35);
    D3 const target(-0.6, 1.35, -0.9);
    add_drifting_camera(document, eye, target, 60, parameters.drift, parameters.duration);
    return document;
}

} // namespace framelet
