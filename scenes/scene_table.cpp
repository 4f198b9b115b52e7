#include "scenes/scene_table.h"

#include "scenes/failure_scenes.h"
#include "scenes/vehicle_scenes.h"

namespace framelet {

std::span<SceneEntry const> scene_table() {
    static SceneEntry const table[] = {
        {"vehicle_fixed", 5, "change in one corner only, then none at all; coarse and fine ground around it", true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -112, .speed = 34}},
                                        .camera = CameraPath::fixed,
                                        .eye = {10.5, 4.2, 17},
                                        .target = {7.2, 1.0, 0},
                                        .vertical_fov = 44,
                                        .yard = true});
         }},
        {"vehicle_chase", 5, "steady: the car stands in the picture, wheels spin, ground and reflections rush by", true,
         [] {
             return make_vehicle_scene({.cars = {{.speed = 24}},
                                        .camera = CameraPath::chase,
                                        .eye = {3.6, 1.7, -6.2},
                                        .target = {0.15, 0.75, 0.6},
                                        .vertical_fov = 40,
                                        .first_stretch = -2,
                                        .last_stretch = 7});
         }},
        {"vehicle_flyby", 5, "the camera pans with the car: all the background moves, horizon and ground texture turn",
         true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -58, .speed = 24, .paint = {0.02, 0.09, 0.42}}},
                                        .camera = CameraPath::pan,
                                        .eye = {4.4, 1.5, 4},
                                        .target = {0, 0.7, 0},
                                        .vertical_fov = 42,
                                        .first_stretch = -5,
                                        .last_stretch = 5});
         }},
        {"vehicle_approach", 5, "mostly still; the region that moves, and the detail in it, grows", true,
         [] {
             return make_vehicle_scene({.cars = {{.start_z = -76, .speed = 17, .paint = {0.75, 0.42, 0.02}}},
                                        .camera = CameraPath::fixed,
                                        .eye = {0.2, 1.25, 9},
                                        .target = {-0.6, 1.1, 0},
                                        .vertical_fov = 36,
                                        .first_stretch = -6,
                                        .last_stretch = 1});
         }},
        {"vehicle_crossing", 5, "cars cross within a third of a second: quick covering and uncovering of fine detail",
         true,
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
        {"windmill", 4, "thin sails and vanes turn quickly before windows and pales", true,
         [] { return make_windmill_scene({.duration = 4, .sail_turns = 5, .vane_turns = 9}); }},
        {"globe", 6, "detail that turns and travels at once, over a mirroring floor", true,
         [] { return make_globe_scene({.duration = 6, .turns = 3}); }},
        {"terrain", 16, "a million triangles, shading that changes from one to the next, a camera in flight", false,
         [] { return make_terrain_scene({.duration = 16}); }},
        {"stop", 6, "everything moves for three seconds, the camera too; then nothing does", true,
         [] { return make_stop_scene({.duration = 6, .moving = 3}); }},
        {"flicker", 4, "nothing moves, but a lamp goes on and off: all of the picture changes at once", true,
         [] {
             return make_flicker_scene({.duration = 4,
                                        .lit = {true, true, true, false, true, false, true, true, false, false, false,
                                                true, false, true, true, true}});
         }},
        {"teleport", 6, "the camera cuts to another place every second; nothing of the old picture is of use", true,
         [] {
             return make_teleport_scene({.duration = 6,
                                         .views = {{{4.5, 1.5, 9}, {-2, 0.8, 2}},
                                                   {{-6.5, 1.2, -6}, {2, 1, -15}},
                                                   {{-30, 14, 30}, {4, 1, 0}},
                                                   {{-1.2, 0.6, -1.5}, {-2.1, 0.6, 2.2}},
                                                   {{9, 3, 22}, {18, 3.5, 4}},
                                                   {{0, 1.7, -70}, {0, 1.4, 0}}}});
         }},
        {"foliage", 8, "alpha-masked twigs, most of them smaller than a pixel, swaying; the camera drifts", true,
         [] { return make_foliage_scene({.duration = 8}); }},
        {"dim", 4, "the right half of the picture is a hundred times darker and moves as much as the left", true,
         [] { return make_dim_scene({.duration = 4, .turns = 3}); }},
    };
    return table;
}

} // namespace framelet
