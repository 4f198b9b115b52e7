// Turns and scales a scene whose file has another axis upwards than y, or another unit than metres, and does not say
// so. In: a scene as it was read, and what somebody says of it. Out: the scene in metres with y upwards.
#pragma once

#include <string>

#include "server/scene/scene.h"

namespace framelet {

/// The coordinate of the axis that is up in a file: 0, 1 or 2 for "x", "y" and "z". Throws InputError for other words.
int parse_up_axis(std::string const& word);

/// Metres of a file's unit: "mm", "cm", "m", "km", "in" or "ft". Throws InputError for other words.
double parse_unit(std::string const& word);

/// Puts a node above all others that turns `up_axis` upwards and makes metres of a unit of `unit_metres`. Axes keep
/// their handedness. Lights and orthographic cameras go along, so that the picture is the same at any size.
void orient_scene(Scene& scene, int up_axis, double unit_metres);

} // namespace framelet
