#include "scenes/scene_table.h"

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
             return make_vehicle_scene({.cars = {{.start_z = -112, .speed = 24, .paint = {0.75, 0.42, 0.02}}},
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
                                        .eye = {-10.5, 1.6, -1},
                                        .target = {0, 1.2, 0},
                                        .vertical_fov = 40,
                                        .first_stretch = -3,
                                        .last_stretch = 3});
         }},
    };
    return table;
}

} // namespace framelet
