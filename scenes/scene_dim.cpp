#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"

namespace framelet {
namespace {

constexpr D3 half_stage{9, 6.5, 7}; // metres

/// Adds floor, walls and what turns on one half of the stage; `shade` multiplies every colour. Returns the nodes that
/// turn.
std::vector<int> add_half(GltfDocument& document, double left, double shade) {
    // Metal has no reflection that keeps its strength when the colour is taken away, as plastic has.
    auto const surface = [&](char const* name, D3 color, int image = no_index) {
        return document.add_material({.name = name,
                                      .base_color = color * shade,
                                      .metallic = shade < 0.5 ? 1.0 : 0.0,
                                      .roughness = 1,
                                      .base_color_texture = image});
    };
    int const floor = surface("floor", D3(0.9), document.add_image(checker_texture()));
    int const bricks = surface("bricks", D3(0.95, 0.62, 0.48), document.add_image(brick_texture()));
    int const boards = surface("boards", D3(0.9, 0.7, 0.4), document.add_image(plank_texture()));
    int const paint = surface("paint", D3(0.25, 0.5, 0.8));
    D3 const floor_center(left + half_stage.x / 2, 0, 0);
    double const inward = left < 0 ? 1 : -1;
    D3 const center(left < 0 ? -2.1 : 2.1, 0, 0); // of the things: near the middle of the picture
    document.add_object("floor", make_ground({half_stage.x, half_stage.z}, 1), floor, {floor_center});
    document.add_object("back", make_box({half_stage.x, half_stage.y, 0.3}, 1.6), bricks,
                        {floor_center + D3(0, half_stage.y / 2, -half_stage.z / 2)});
    std::vector<int> turning;
    MeshData wheel = make_torus(0.95, 0.09, 48, 10);
    for (int spoke = 0; spoke < 12; ++spoke) {
        DQuat const turned = rotation_about({0, 1, 0}, pi * spoke / 6);
        append(wheel, make_rounded_box({0.06, 0.06, 0.9}, 0.02), {turned * D3(0, 0, 0.47), turned, {1, 1, 1}});
    }
    wheel.uv.clear();
    int const stand =
        document.add_node({.name = "stand",
                           .place = {center + D3(0.4 * inward, 1.9, -1.6),
                                     rotation_about({1, 0, 0}, pi / 2) * rotation_about({0, 0, 1}, 0.2)}});
    turning.push_back(document.add_object("wheel", std::move(wheel), paint, {}, stand));
    turning.push_back(
        document.add_object("crate", make_box(D3(1.1), 1.1), boards, {center + D3(-1.0 * inward, 0.56, 0.6)}));
    document.add_object("ball", make_sphere(0.55, 32), paint, {center + D3(0.9 * inward, 0.55, 1.0)});
    return turning;
}

} // namespace

GltfDocument make_dim_scene(DimParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.25, 0.75, 0.60});
    std::vector<int> const light = add_half(document, -half_stage.x, 1);
    std::vector<int> const dark = add_half(document, 0, parameters.soot);
    for (std::vector<int> const& half : {light, dark}) {
        document.tracks.push_back(spin_track({half[0]}, {0, 1, 0}, 2 * pi * parameters.turns, parameters.duration));
        document.tracks.push_back(spin_track({half[1]}, {0, 1, 0}, 2 * pi, parameters.duration));
    }
    add_camera(document, {0, 2.6, 7.6}, {0, 1.6, -1}, 40);
    return document;
}

} // namespace framelet
