#include "scenes/failure_scenes.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/gait.h"
#include "scenes/things/landscape.h"
#include "scenes/things/props.h"

namespace framelet {

GltfDocument make_walker_scene(WalkerParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {0.45, 0.80, 0.40});
    add_surroundings(document);
    add_meadow(document, 120);
    int const bricks = document.add_material({.name = "bricks",
                                              .base_color = D3(0.80, 0.45, 0.33),
                                              .roughness = 0.9,
                                              .base_color_texture = document.add_image(brick_texture())});
    int const stone = document.add_material({.name = "stone",
                                             .base_color = D3(0.75, 0.72, 0.66),
                                             .roughness = 0.8,
                                             .base_color_texture = document.add_image(slab_texture())});
    document.add_object("slabs", make_ground({18, 11}, 1.6), stone, {{0, 0.02, 0}});
    document.add_object("wall", make_box({18, 1.9, 0.4}, 1.6), bricks, {{0, 0.97, -4.6}});
    document.add_object("coping", make_box({18.2, 0.1, 0.56}, 2), stone, {{0, 1.97, -4.6}});
    document.add_object("base", make_box({0.7, 0.3, 0.7}, 0.7), stone, {{0, 0.17, 0}});
    document.add_object("column", make_cylinder(0.2, 2.6, 28), stone, {{0, 0.3, 0}});
    document.add_object("head", make_box({0.6, 0.16, 0.6}, 0.7), stone, {{0, 2.98, 0}});
    int const house = add_house_mesh(document, 5, 2, 2);
    document.add_node({.name = "house", .place = {{-6, 0, -17}}, .mesh = house});
    int const tree = add_broadleaf_mesh(document, 3);
    for (double const x : {5.0, 9.5}) {
        document.add_node({.name = "tree", .place = {{x, 0, -9}, DQuat(1, 0, 0, 0), D3(6)}, .mesh = tree});
    }

    D3 const center(0, 0.02, 0);
    int const walker = add_figure_mesh(document, {.shirt = D3(0.95),
                                                  .trousers = D3(0.22, 0.30, 0.50),
                                                  .shoes = D3(0.09, 0.05, 0.03),
                                                  .skin = D3(0.72, 0.46, 0.34),
                                                  .hair = D3(0.07, 0.04, 0.025)});
    int const runner = add_figure_mesh(document, {.shirt = D3(0.95, 0.75, 0.15),
                                                  .trousers = D3(0.16, 0.17, 0.19),
                                                  .shoes = D3(0.75, 0.76, 0.80),
                                                  .skin = D3(0.42, 0.24, 0.16),
                                                  .hair = D3(0.02)});
    add_going_figure(document, walker, walking, {parameters.walk_radius, parameters.walk_cycles, parameters.duration},
                     center, radians(-135));
    add_going_figure(document, runner, running, {-parameters.run_radius, parameters.run_cycles, parameters.duration},
                     center, radians(30));
    add_camera(document, {0.9, 1.75, 6.0}, {0, 1.02, 0}, 36);
    return document;
}

} // namespace framelet
