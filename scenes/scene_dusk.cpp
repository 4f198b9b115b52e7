#include <array>
#include <cmath>

#include "scenes/gltf/animations.h"
#include "scenes/lit_scenes.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/gait.h"
#include "scenes/things/landscape.h"
#include "scenes/things/vehicle.h"

namespace framelet {
namespace {

constexpr double street_half = 4.2, pavement = 2.2; // metres
constexpr double street_length = 96;

/// Two sides of houses, whose windows are dark or lit in one of three colours.
void add_houses(GltfDocument& document) {
    std::array<int, 3> const plasters{
        document.add_material({.name = "ochre plaster", .base_color = D3(0.60, 0.42, 0.22), .roughness = 0.9}),
        document.add_material({.name = "grey plaster", .base_color = D3(0.50, 0.50, 0.48), .roughness = 0.9}),
        document.add_material({.name = "brick house",
                               .base_color = D3(0.62, 0.34, 0.25),
                               .roughness = 0.9,
                               .base_color_texture = document.add_image(brick_texture())})};
    std::array<int, 4> const panes{
        document.add_material({.name = "dark pane", .base_color = D3(0.02, 0.025, 0.03), .roughness = 0.05}),
        document.add_material({.name = "warm pane", .base_color = D3(0.1), .emissive = D3(1.7, 1.0, 0.42)}),
        document.add_material({.name = "white pane", .base_color = D3(0.1), .emissive = D3(1.2, 1.05, 0.8)}),
        document.add_material({.name = "blue pane", .base_color = D3(0.1), .emissive = D3(0.25, 0.42, 0.9)})};
    int const trim = document.add_material({.name = "trim", .base_color = D3(0.72, 0.70, 0.64), .roughness = 0.7});
    std::array<MeshData, 3> walls;
    std::array<MeshData, 4> windows;
    MeshData frames;
    double const face = street_half + pavement;
    for (int const side : {-1, 1}) {
        DQuat const facing = rotation_about({0, 1, 0}, -side * pi / 2); // the street
        double z = -street_length / 2;
        for (int house = 0; z < street_length / 2; ++house) {
            auto const random = [&](int what) { return random_unit(500, side, house, what); };
            int const bays = 3 + static_cast<int>(3 * random(0));
            int const floors = 2 + static_cast<int>(2.99 * random(1));
            D3 const size(7, 3.1 * floors + 0.6, 2.7 * bays + 0.8);
            D3 const middle(side * (face + size.x / 2), 0, z + size.z / 2);
            append(walls[static_cast<std::size_t>(house + (side > 0 ? 1 : 0)) % walls.size()], make_box(size, 1.6),
                   {middle + D3(0, size.y / 2, 0)});
            append(frames, make_box({size.x + 0.3, 0.25, size.z}, 0.6), {middle + D3(0, size.y, 0)});
            for (int floor = 0; floor < floors; ++floor) {
                for (int bay = 0; bay < bays; ++bay) {
                    D3 const at(side * face, 3.1 * floor + 1.75, z + 0.4 + 2.7 * (bay + 0.5));
                    double const lot = random_unit(501 + static_cast<std::uint32_t>(side + 1), house, floor, bay);
                    std::size_t const kind = lot < 0.48 ? 0 : lot < 0.78 ? 1 : lot < 0.93 ? 2 : 3;
                    Placement const in_front{at - D3(side * 0.02, 0.75, 0), facing, D3(1)};
                    append(windows[kind], make_card({1.1, 1.5}), in_front);
                    append(frames, make_box({0.12, 0.09, 1.4}, 0.6), {at + D3(0, -0.8, 0)});
                    append(frames, make_card({0.06, 1.5}), {at - D3(side * 0.03, 0.75, 0), facing, D3(1)});
                }
            }
            z += size.z;
        }
    }
    for (std::size_t i = 0; i < walls.size(); ++i) {
        document.add_object("houses", std::move(walls[i]), plasters[i]);
    }
    for (std::size_t i = 0; i < windows.size(); ++i) {
        document.add_object(i == 0 ? "dark windows" : "lit windows", std::move(windows[i]), panes[i]);
    }
    document.add_object("trim", std::move(frames), trim);
}

void add_street(GltfDocument& document) {
    int const asphalt = document.add_material({.name = "asphalt",
                                               .base_color = D3(0.16, 0.16, 0.17),
                                               .roughness = 0.45, // it has rained
                                               .base_color_texture = document.add_image(asphalt_texture())});
    int const slabs = document.add_material({.name = "slabs",
                                             .base_color = D3(0.42, 0.41, 0.39),
                                             .roughness = 0.8,
                                             .base_color_texture = document.add_image(slab_texture())});
    int const paint = document.add_material({.name = "road paint", .base_color = D3(0.7), .roughness = 0.6});
    document.add_object("street", make_ground({2 * street_half, street_length}, 3), asphalt);
    MeshData sides, dashes;
    for (double const side : {-1.0, 1.0}) {
        append(sides, make_box({pavement, 0.14, street_length}, 1.6), {{side * (street_half + pavement / 2), 0.07, 0}});
    }
    for (double z = -street_length / 2 + 2; z < street_length / 2; z += 4) {
        append(dashes, make_ground({0.14, 1.8}, 1), {{0, 0.012, z}});
    }
    document.add_object("pavements", std::move(sides), slabs);
    document.add_object("dashes", std::move(dashes), paint);
}

/// What is left of the day: a dome that glows, brightest where the street ends, and a faint light from above it.
void add_evening(GltfDocument& document) {
    MeshData dome = make_surface(24, 12, [](double u, double v) {
        double const around = 2 * pi * (u >= 1 ? 0 : u), up = 0.5 * pi * v - 0.06;
        return 300.0 * D3(std::cos(up) * std::cos(around), std::sin(up), std::cos(up) * std::sin(around));
    });
    for (D3 const& p : dome.positions) {
        D3 const way = glm::normalize(p);
        double const low = std::pow(1 - std::max(way.y, 0.0), 4), west = 0.5 - 0.5 * way.z;
        dome.colors.push_back(D3(0.035, 0.055, 0.12) + low * (0.2 + 0.8 * west) * D3(0.42, 0.22, 0.16));
    }
    dome.uv.clear();
    int const sky = document.add_material({.name = "evening sky", .double_sided = true, .unlit = true});
    document.add_object("sky", std::move(dome), sky);
    document.lights.push_back({"directional", {0.35, 0.45, 0.9}, 0.12});
    document.add_node({.name = "sky light", .place = {.rotation = looking_at({0.2, 1, -0.3}, {0, 0, 0})}, .light = 0});
}

void add_street_lamps(GltfDocument& document) {
    int const iron = document.add_material({.name = "iron", .base_color = D3(0.03), .metallic = 0.6, .roughness = 0.5});
    int const glow = document.add_material({.name = "lamp glass", .base_color = D3(0.8), .emissive = D3(7, 4.8, 2.6)});
    MeshData post;
    append(post, make_lathe(std::array<D2, 4>{D2(0.1, 0), D2(0.06, 0.6), D2(0.045, 4.6), D2(0, 4.6)}, 12));
    append(post, make_box({1.3, 0.06, 0.06}), {{0.6, 4.6, 0}});
    append(post, make_cone(0.24, 0.14, 16), {{1.2, 4.52, 0}});
    post.uv.clear();
    int const mesh = document.add_mesh("street lamp", {{std::move(post), iron}});
    document.lights.push_back({"point", {1.0, 0.70, 0.40}, 26});
    for (int i = 0; i < 6; ++i) {
        double const side = i % 2 == 0 ? 1 : -1;
        D3 const foot(side * (street_half + 0.4), 0.14, 10.0 - 9.0 * i);
        int const lamp = document.add_node(
            {.name = "lamp", .place = {foot, rotation_about({0, 1, 0}, side > 0 ? pi : 0.0), D3(1)}, .mesh = mesh});
        document.add_object("lamp glass", make_cylinder(0.09, 0.04, 12), glow, {{1.2, 4.47, 0}}, lamp);
        document.add_node({.name = "lamp light", .place = {{1.2, 4.38, 0}}, .light = 1}, lamp);
    }
}

/// A car that comes down the street with its headlights on.
void add_car(GltfDocument& document, DuskParameters const& parameters) {
    Vehicle const car = add_vehicle(document, add_vehicle_meshes(document, {0.45, 0.02, 0.03}));
    D3 const start(-2, 0.02, -30), end(-2, 0.02, 18);
    document.tracks.push_back(line_track(car.root, start, end, parameters.duration));
    double const turns = std::round((end.z - start.z) / wheel_radius / (2 * pi / wheel_spokes));
    document.tracks.push_back(spin_track({car.wheels.begin(), car.wheels.end()}, {1, 0, 0},
                                         turns * 2 * pi / wheel_spokes, parameters.duration));
    document.lights.push_back({"point", {1.0, 0.95, 0.85}, 14});
    int const light = static_cast<int>(document.lights.size()) - 1;
    document.add_node({.name = "headlights", .place = {{0, 0.62, 2.9}}, .light = light}, car.root);
}

} // namespace

GltfDocument make_dusk_scene(DuskParameters const& parameters) {
    GltfDocument document;
    document.light = "full";
    add_evening(document);
    add_street(document);
    add_houses(document);
    add_street_lamps(document);
    add_car(document, parameters);
    int const walker = add_figure_mesh(document, {.shirt = D3(0.65, 0.12, 0.10),
                                                  .trousers = D3(0.10, 0.12, 0.20),
                                                  .shoes = D3(0.05),
                                                  .skin = D3(0.62, 0.40, 0.30),
                                                  .hair = D3(0.05, 0.03, 0.02)});
    add_going_figure(document, walker, walking, {0.7, 3, parameters.duration}, {street_half + 1.1, 0.14, 2}, 0);
    int const camera = add_camera(document, {2.4, 1.7, 17}, {-0.6, 2.2, -6}, 48);
    document.tracks.push_back(line_track(camera, {2.4, 1.7, 17}, {2.4, 1.7, 13}, parameters.duration));
    return document;
}

} // namespace framelet
