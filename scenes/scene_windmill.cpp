#include <array>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/things/landscape.h"
#include "scenes/things/props.h"

namespace framelet {
namespace {

constexpr double hub_height = 8.2;

MeshData make_sails(int count) {
    MeshData sails;
    constexpr double length = 6.4;
    for (int sail = 0; sail < count; ++sail) {
        DQuat const turned = rotation_about({0, 0, 1}, 2 * pi * sail / count);
        auto const add_bar = [&](D3 size, D3 center) {
            append(sails, make_box(size), {turned * center, turned, {1, 1, 1}});
        };
        add_bar({0.12, length, 0.10}, {0, length / 2, 0});
        for (double const x : {0.45, 0.9}) { // the lattice stands to one side of the stock
            add_bar({0.04, length - 1.2, 0.04}, {x, length / 2 + 0.5, 0});
        }
        for (int lath = 0; lath < 18; ++lath) {
            add_bar({0.95, 0.035, 0.03}, {0.45, 1.15 + lath * (length - 1.3) / 17, 0});
        }
    }
    append(sails, make_sphere(0.28, 20));
    sails.uv.clear();
    return sails;
}

MeshData make_vane_wheel(int count) {
    MeshData wheel;
    for (int vane = 0; vane < count; ++vane) {
        DQuat const turned = rotation_about({0, 0, 1}, 2 * pi * vane / count);
        DQuat const pitched = turned * rotation_about({0, 1, 0}, radians(35));
        append(wheel, make_box({0.16, 0.75, 0.015}), {turned * D3(0, 0.85, 0), pitched, {1, 1, 1}});
        append(wheel, make_box({0.025, 1.1, 0.025}), {turned * D3(0, 0.6, 0), turned, {1, 1, 1}});
    }
    append(wheel, make_torus(1.2, 0.02, 48, 6), {{0, 0, 0}, rotation_about({1, 0, 0}, pi / 2), {1, 1, 1}});
    append(wheel, make_sphere(0.12, 12));
    wheel.uv.clear();
    return wheel;
}

MeshData make_derrick() {
    MeshData derrick;
    for (int leg = 0; leg < 4; ++leg) {
        double const x = leg % 2 == 0 ? 1 : -1;
        double const z = leg < 2 ? 1 : -1;
        append(derrick, make_box({0.09, 5.3, 0.09}),
               {{x * 0.45, 2.6, z * 0.45},
                rotation_about({0, 0, 1}, x * 0.12) * rotation_about({1, 0, 0}, -z * 0.12),
                {1, 1, 1}});
    }
    for (double const y : {1.0, 2.2, 3.4, 4.6}) {
        double const width = 1.6 - 0.24 * y;
        for (double const z : {-width / 2, width / 2}) {
            append(derrick, make_box({width, 0.05, 0.05}), {{0, y, z}});
        }
    }
    derrick.uv.clear();
    return derrick;
}

} // namespace

GltfDocument make_windmill_scene(WindmillParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.42, 0.80, 0.45});
    add_surroundings(document);
    add_meadow(document, 120);
    int const plaster =
        document.add_material({.name = "whitewash", .base_color = D3(0.75, 0.73, 0.68), .roughness = 0.9});
    int const wood = document.add_material({.name = "dark wood", .base_color = D3(0.09, 0.05, 0.03), .roughness = 0.7});
    int const tin = document.add_material({.name = "tin", .base_color = D3(0.75), .metallic = 0.9, .roughness = 0.25});

    std::array<D2, 5> const tower{D2(2.6, 0), D2(2.2, 2.5), D2(1.9, 5), D2(1.65, 7.6), D2(1.6, 7.6)};
    std::array<D2, 5> const cap{D2(1.75, 7.5), D2(1.8, 7.9), D2(1.45, 8.7), D2(0.8, 9.3), D2(0, 9.5)};
    D3 const mill(-2.2, 0, -3);
    document.add_object("mill", make_lathe(tower, 40), plaster, {mill});
    document.add_object("cap", make_lathe(cap, 40), wood, {mill});
    int const sails = document.add_object("sails", make_sails(parameters.sails), wood, {mill + D3(0, hub_height, 2.1)});
    document.add_object("derrick", make_derrick(), wood, {{6.3, 0, -1.2}});
    int const vanes = document.add_object("vane wheel", make_vane_wheel(parameters.vanes), tin, {{6.3, 5.3, -0.5}});

    int const long_house = add_house_mesh(document, 8, 2, 3);
    for (double const x : {-25.5, 0.0, 25.5}) {
        document.add_node({.name = "house", .place = {{x, 0, -20}}, .mesh = long_house});
    }
    int const fence = add_fence_mesh(document, 12);
    for (double const x : {-12.0, 0.0, 12.0}) {
        document.add_node({.name = "fence", .place = {{x, 0, 1.2}}, .mesh = fence});
    }
    document.tracks.push_back(spin_track({sails}, {0, 0, 1}, -2 * pi * parameters.sail_turns, parameters.duration));
    document.tracks.push_back(spin_track({vanes}, {0, 0, 1}, 2 * pi * parameters.vane_turns, parameters.duration));
    add_camera(document, {1.6, 2.2, 21}, {-0.4, 6.4, 0}, 43);
    return document;
}

} // namespace framelet
