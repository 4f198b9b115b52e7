#include "scenes/scene_table.h"

#include "scenes/failure_scenes.h"
#include "scenes/large_scenes.h"
#include "scenes/lit_scenes.h"
#include "scenes/vehicle_scenes.h"

namespace framelet {

std::span<SceneEntry const> scene_table() {
    static SceneEntry const table[] = {
        {"vehicle_fixed", 5, true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -112, .speed = 34}},
                                        .camera = CameraPath::fixed,
                                        .eye = {10.5, 4.2, 17},
                                        .target = {7.2, 1.0, 0},
                                        .vertical_fov = 44,
                                        .yard = true});
         }},
        {"vehicle_chase", 5, true,
         [] {
             return make_vehicle_scene({.cars = {{.speed = 24}},
                                        .camera = CameraPath::chase,
                                        .eye = {3.6, 1.7, -6.2},
                                        .target = {0.15, 0.75, 0.6},
                                        .vertical_fov = 40,
                                        .first_stretch = -2,
                                        .last_stretch = 7});
         }},
        {"vehicle_flyby", 5, true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -58, .speed = 24, .paint = {0.02, 0.09, 0.42}}},
                                        .camera = CameraPath::pan,
                                        .eye = {4.4, 1.5, 4},
                                        .target = {0, 0.7, 0},
                                        .vertical_fov = 42,
                                        .first_stretch = -5,
                                        .last_stretch = 5});
         }},
        {"vehicle_approach", 5, true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -76, .speed = 17, .paint = {0.75, 0.42, 0.02}}},
                                        .camera = CameraPath::fixed,
                                        .eye = {0.2, 1.25, 9},
                                        .target = {-0.6, 1.1, 0},
                                        .vertical_fov = 36,
                                        .first_stretch = -6,
                                        .last_stretch = 1});
         }},
        {"vehicle_crossing", 5, true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -60, .speed = 60, .paint = {0.6, 0.6, 0.62}},
                                                 {.lane_x = far_lane_x, .start_z = 200, .speed = -60}},
                                        .camera = CameraPath::fixed,
                                        .eye = {-10.5, 1.6, -14},
                                        .target = {0, 1.4, -15},
                                        .vertical_fov = 40,
                                        .first_stretch = -3,
                                        .last_stretch = 3});
         }},
        {"windmill", 4, true, [] { return make_windmill_scene({.duration = 4, .sail_turns = 5, .vane_turns = 9}); }},
        {"globe", 6, true, [] { return make_globe_scene({.duration = 6, .turns = 3}); }},
        {"terrain", 16, false, [] { return make_terrain_scene({.duration = 16}); }},
        {"stop", 6, true, [] { return make_stop_scene({.duration = 6, .moving = 3}); }},
        {"flicker", 4, true,
         [] {
             return make_flicker_scene({.duration = 4,
                                        .lit = {true, true, true, false, true, false, true, true, false, false, false,
                                                true, false, true, true, true}});
         }},
        {"teleport", 6, true,
         [] {
             return make_teleport_scene({.duration = 6,
                                         .views = {{{4.5, 1.5, 9}, {-2, 0.8, 2}},
                                                   {{-6.5, 1.2, -6}, {2, 1, -15}},
                                                   {{-30, 14, 30}, {4, 1, 0}},
                                                   {{-1.2, 0.6, -1.5}, {-2.1, 0.6, 2.2}},
                                                   {{9, 3, 22}, {18, 3.5, 4}},
                                                   {{0, 1.7, -70}, {0, 1.4, 0}}}});
         }},
        {"foliage", 8, true, [] { return make_foliage_scene({.duration = 8}); }},
        {"dim", 4, true, [] { return make_dim_scene({.duration = 4, .turns = 3}); }},
        {"walker", 4, true, [] { return make_walker_scene({.duration = 4}); }},
        {"flag", 4, true, [] { return make_flag_scene({.duration = 4}); }},
        {"fan", 4, true, [] { return make_fan_scene({.duration = 4}); }},
        {"glass", 4, true, [] { return make_glass_scene({.duration = 4}); }},
        {"interior", 8, true, [] { return make_interior_scene({.duration = 8}); }},
        {"dusk", 6, true, [] { return make_dusk_scene({.duration = 6}); }},
    };
    return table;
}

std::span<SceneEntry const> large_scene_table() {
    static SceneEntry const table[] = {
        {"terrain_large", 16, false, // 20 million triangles
         [] { return make_terrain_scene({.duration = 16, .columns = 3163, .rows = 3163, .cell = 0.0629}); }},
        {"forest", 20, false, [] { return make_forest_scene({.duration = 20}); }}, // 100 million, in instances
    };
    return table;
}

} // namespace framelet
