// What the user may ask of the viewer, other than by moving the camera.
#pragma once

namespace framelet {

/// What a key, or a button of the overlay, stands for.
enum class Command {
    quit,
    reset,
    reconnect,
    play_or_pause,
    step_forward,
    step_back,
    seek_start,
    seek_forward,
    seek_back,
    faster,
    slower,
    brighter,
    darker,
    free_camera,
    fit_scene,
    toggle_fullscreen,
    toggle_help,
    toggle_statistics,
    toggle_time_line,
    next_overlay,
    toggle_reprojection,
    toggle_smoothing,
    screenshot,
    scene_camera, ///< the first; `scene_camera` + n is the n-th more, up to 8 more
};

} // namespace framelet
