#include <array>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"

namespace framelet {
namespace {

/// Adds a glazed screen of two panes about `center`, 2.6 m wide, and a wheel and a crate that turn behind it. Returns
/// wheel and crate.
std::array<int, 2> add_window(GltfDocument& document, D3 center) {
    int const wood = document.add_material({.name = "frame", .base_color = D3(0.16, 0.09, 0.05), .roughness = 0.6});
    int const glass = document.add_material({.name = "glass",
                                             .base_color = D3(0.80, 0.95, 0.88),
                                             .roughness = 0,
                                             .double_sided = true,
                                             .transmission = 0.95});
    int const paint = document.add_material({.name = "paint", .base_color = D3(0.70, 0.20, 0.10), .roughness = 0.5});
    int const boards = document.add_material({.name = "boards",
                                              .base_color = D3(0.9, 0.7, 0.4),
                                              .roughness = 0.9,
                                              .base_color_texture = document.add_image(plank_texture())});
    for (double const x : {-0.65, 0.65}) {
        document.add_object("pane", make_card({1.22, 2}), glass, {center + D3(x, 0.2, 0)});
    }
    for (double const x : {-1.3, 0.0, 1.3}) {
        document.add_object("post", make_box({0.08, 2.3, 0.08}), wood, {center + D3(x, 1.15, 0)});
    }
    document.add_object("rail", make_box({2.68, 0.08, 0.08}), wood, {center + D3(0, 2.25, 0)});
    MeshData wheel = make_torus(0.6, 0.07, 40, 10);
    for (int spoke = 0; spoke < 6; ++spoke) {
        append(wheel, make_box({0.05, 0.05, 1.2}), {{0, 0, 0}, rotation_about({0, 1, 0}, pi * spoke / 6), D3(1)});
    }
    wheel.uv.clear();
    int const stand = document.add_node(
        {.name = "stand", .place = {center + D3(-0.6, 1.3, -0.8), rotation_about({1, 0, 0}, pi / 2)}});
    return {document.add_object("wheel", std::move(wheel), paint, {}, stand),
            document.add_object("crate", make_box(D3(0.7), 0.7), boards, {center + D3(0.65, 0.9, -0.9)})};
}

} // namespace

GltfDocument make_glass_scene(GlassParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.2, 0.80, -0.55}); // ahead of the camera: what is smooth shines
    int const floor = document.add_material({.name = "floor",
                                             .base_color = D3(0.55, 0.5, 0.45),
                                             .roughness = 0.35,
                                             .base_color_texture = document.add_image(checker_texture())});
    int const bricks = document.add_material({.name = "bricks",
                                              .base_color = D3(0.85, 0.5, 0.38),
                                              .roughness = 0.9,
                                              .base_color_texture = document.add_image(brick_texture())});
    int const brass =
        document.add_material({.name = "brass", .base_color = D3(0.85, 0.63, 0.28), .metallic = 1, .roughness = 0.35});
    int const lacquer =
        document.add_material({.name = "lacquer", .base_color = D3(0.02, 0.03, 0.10), .roughness = 0.25});
    document.add_object("floor", make_ground({16, 12}, 1), floor);
    document.add_object("wall", make_box({16, 2.6, 0.3}, 1.6), bricks, {{0, 1.3, -4.5}});
    auto const [wheel, crate] = add_window(document, {-1.5, 0, -0.5});
    document.add_object("drum", make_cylinder(0.55, 1.5, 64), lacquer, {{1.0, 0, -0.8}});
    document.add_object("ball", make_sphere(0.5, 48), lacquer, {{2.4, 0.5, 0.4}});
    document.add_object("table", make_rounded_box({1.7, 0.1, 1.1}, 0.04), lacquer, {{1.5, 0.55, 1.3}});
    document.add_object("ring", make_torus(0.35, 0.12, 48, 16), brass, {{1.5, 0.72, 1.3}});

    document.tracks.push_back(spin_track({wheel}, {0, 1, 0}, 2 * pi * parameters.turns, parameters.duration));
    document.tracks.push_back(spin_track({crate}, {0, 1, 0}, 2 * pi, parameters.duration));
    int const camera = add_camera(document, {0, 1.7, 4.3}, {0, 0.85, -0.5}, 45);
    document.tracks.push_back(translation_track(camera, parameters.duration, 64, [&](double time) {
        return D3(parameters.drift * std::sin(2 * pi * time / parameters.duration), 1.7, 4.3);
    }));
    return document;
}

} // namespace framelet
