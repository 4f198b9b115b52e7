// Commands that the user may give to the viewer, other than by moving the camera.
#pragma once

#include <cstdint>

namespace framelet {

/// A command that a key, or a button of the overlay, stands for.
enum class Command : std::uint8_t {
    quit,
    escape, ///< as `EscapeKey`
    reset,
    reconnect,
    open_file,
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
    sharper,
    fresher,
    free_camera,
    mouse_look, ///< begin it, or end it
    fit_scene,
    view_front,
    view_back,
    view_right,
    view_left,
    view_top,
    view_below,
    toggle_projection,
    add_bookmark,
    remove_bookmark,
    copy_camera,
    paste_camera,
    save_camera,
    toggle_fullscreen,
    toggle_help,
    toggle_statistics,
    toggle_details,
    toggle_time_line,
    next_overlay,
    toggle_reprojection,
    toggle_smoothing,
    screenshot,
    screenshot_with_depth,
    toggle_recording,
    scene_camera, ///< camera 1 of the scene; `scene_camera` + n is the n-th more, up to 8 more
    bookmark = scene_camera + 9, ///< bookmark 1, likewise
};

/// Number of cameras of each kind that have a key.
inline constexpr int numbered_cameras = 9;

/// The command of number n, from 0, of those that begin with `first`.
constexpr Command numbered(Command first, int n) {
    return static_cast<Command>(static_cast<int>(first) + n);
}

} // namespace framelet
