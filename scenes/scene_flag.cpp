#include <array>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"
#include "scenes/things/props.h"

namespace framelet {
namespace {

/// A wave along the cloth: how far it swings to either side, once the cloth is free of its mast, and its phase.
struct Wave {
    double height; ///< metres
    D2 phase; ///< radians a metre, away from the mast and up
};

/// Swing at a place of the cloth, whose mast is at x = 0, and its slopes along x and y. The wave cos(phase - t) is
/// cos(phase) cos(t) + sin(phase) sin(t): a target for each, of which `quarter` 1 is the second.
D3 swing(Wave const& wave, int quarter, D2 at) {
    constexpr double free_from = 0.5; // metres
    double const held = std::exp(-at.x / free_from);
    double const phase = glm::dot(wave.phase, at) - quarter * pi / 2;
    double const height = wave.height * (1 - held);
    return {height * std::cos(phase),
            wave.height * held / free_from * std::cos(phase) - height * wave.phase.x * std::sin(phase),
            -height * wave.phase.y * std::sin(phase)};
}

/// The cloth as a flat primitive in the XY plane, with two targets for each wave.
GltfPrimitive make_cloth(MeshData flat, int material, std::array<Wave, 2> const& waves) {
    GltfPrimitive cloth{std::move(flat), material};
    for (Wave const& wave : waves) {
        for (int quarter = 0; quarter < 2; ++quarter) {
            GltfMorphTarget target;
            for (D3 const& position : cloth.data.positions) {
                D3 const at = swing(wave, quarter, D2(position));
                target.positions.push_back({0, 0, at.x});
                target.normals.push_back({-at.y, -at.z, 0}); // exact, once they have been made unit length
            }
            cloth.targets.push_back(std::move(target));
        }
    }
    return cloth;
}

GltfTrack wave_track(int node, FlagParameters const& parameters, double start) {
    GltfTrack track{{node}, GltfPath::weights, false, {}, {}};
    constexpr int keys = 128;
    for (int key = 0; key <= keys; ++key) {
        double const share = double(key) / keys;
        double const first = 2 * pi * (parameters.long_waves * share + start);
        double const second = 2 * pi * (parameters.short_waves * share + start);
        track.times.push_back(parameters.duration * share);
        track.values.push_back({std::cos(first), std::sin(first), std::cos(second), std::sin(second)});
    }
    return track;
}

/// A mast that stands at `foot`, with a ball on top and the line by which a flag is raised.
void add_mast(GltfDocument& document, D3 foot, double height, double radius) {
    int const paint =
        document.add_material({.name = "mast paint", .base_color = D3(0.80, 0.80, 0.78), .roughness = 0.35});
    int const brass =
        document.add_material({.name = "brass", .base_color = D3(0.85, 0.63, 0.28), .metallic = 1, .roughness = 0.2});
    int const hemp = document.add_material({.name = "rope", .base_color = D3(0.42, 0.33, 0.20), .roughness = 0.9});
    std::array<D2, 3> const profile{D2(radius, 0), D2(0.6 * radius, height), D2(0, height)};
    document.add_object("mast", make_lathe(profile, 20), paint, {foot});
    document.add_object("ball", make_sphere(1.6 * radius, 20), brass, {foot + D3(0, height + radius, 0)});
    MeshData lines;
    for (double const z : {-0.5, 0.5}) {
        append(lines, make_cylinder(0.010, height - 1.1, 6), {{1.25 * radius, 1.0, z * radius}});
    }
    append(lines, make_torus(0.05, 0.012, 16, 6),
           {{1.25 * radius, 1.0, 0}, rotation_about({0, 0, 1}, pi / 2), {1, 1, 1}});
    lines.uv.clear();
    document.add_object("lines", std::move(lines), hemp, {foot});
}

/// Stays of rope from up the mast to pegs in the lawn.
void add_stays(GltfDocument& document, D3 foot, double height) {
    int const hemp = document.add_material({.name = "rope", .base_color = D3(0.42, 0.33, 0.20), .roughness = 0.9});
    MeshData stays;
    for (double const angle : {0.6, 2.6, 4.7}) {
        D3 const way = D3(2.6 * std::cos(angle), -height, 2.6 * std::sin(angle));
        DQuat const turned = looking_at({0, 0, 0}, way) * rotation_about({1, 0, 0}, -pi / 2);
        append(stays, make_cylinder(0.012, glm::length(way), 6), {{0, height, 0}, turned, {1, 1, 1}});
    }
    stays.uv.clear();
    document.add_object("stays", std::move(stays), hemp, {foot});
}

} // namespace

GltfDocument make_flag_scene(FlagParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {0.30, 0.80, 0.52});
    add_surroundings(document);
    add_meadow(document, 120);
    int const printed = document.add_material({.name = "flag",
                                               .roughness = 0.8,
                                               .base_color_texture = document.add_image(flag_texture()),
                                               .double_sided = true});
    int const striped = document.add_material({.name = "pennant",
                                               .base_color = D3(1.0, 0.72, 0.25),
                                               .roughness = 0.8,
                                               .base_color_texture = document.add_image(stripe_texture()),
                                               .double_sided = true});

    D3 const mast(-1.9, 0, 0);
    DQuat const towards_camera = rotation_about({0, 1, 0}, radians(-28)); // the wind comes from the left and behind
    add_mast(document, mast, 6.4, 0.07);
    add_stays(document, mast, 3.6);
    // Its free end hangs a little.
    MeshData const flag =
        make_surface(44, 28, [](double u, double v) { return D3(3.3 * u, 2.2 * v - 0.25 * u * u, 0); }, {1, -1});
    int const flag_mesh =
        document.add_mesh("flag", {make_cloth(flag, printed, {{{0.30, {2.6, 0.5}}, {0.08, {5.3, -1.2}}}})});
    int const flag_node =
        document.add_node({.name = "flag", .place = {mast + D3(0.07, 3.95, 0.04), towards_camera}, .mesh = flag_mesh});
    document.tracks.push_back(wave_track(flag_node, parameters, 0));

    D3 const small_mast(2.6, 0, 1.4);
    add_mast(document, small_mast, 3.4, 0.045);
    MeshData const pennant = make_surface(
        26, 8, [](double u, double v) { return D3(1.5 * u, 0.62 * (v - 0.5) * (1 - 0.94 * u) - 0.16 * u * u, 0); },
        {1, 2});
    int const pennant_mesh =
        document.add_mesh("pennant", {make_cloth(pennant, striped, {{{0.13, {4.6, 0}}, {0.05, {9, 1}}}})});
    int const pennant_node = document.add_node(
        {.name = "pennant", .place = {small_mast + D3(0.05, 2.95, 0.03), towards_camera}, .mesh = pennant_mesh});
    document.tracks.push_back(wave_track(pennant_node, parameters, 0.3));

    int const house = add_house_mesh(document, 6, 2, 2);
    document.add_node({.name = "house", .place = {{3, 0, -16}}, .mesh = house});
    std::array<int, 2> const trees{add_broadleaf_mesh(document, 3), add_conifer_mesh(document, 1)};
    for (int i = 0; i < 5; ++i) {
        D3 const place(-15.0 + 4.2 * i + (i > 2 ? 9 : 0), 0, -13.0 - 1.5 * (i % 2));
        document.add_node({.name = "tree",
                           .place = {place, rotation_about({0, 1, 0}, i), D3(6.0 + i % 3)},
                           .mesh = trees[static_cast<std::size_t>(i % 2)]});
    }
    int const fence = add_fence_mesh(document, 12);
    for (double const x : {-12.0, 0.0, 12.0}) {
        document.add_node({.name = "fence", .place = {{x, 0, -5}}, .mesh = fence});
    }
    add_camera(document, {0.3, 1.7, 8.6}, {0.2, 3.3, 0}, 46);
    return document;
}

} // namespace framelet
