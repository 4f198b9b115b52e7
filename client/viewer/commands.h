// Commands that the user may give to the viewer, other than by moving the camera: the one table of their keys and
// words, from which the window takes its keys, the help its lines and the tooltips theirs. In: a key; why some commands
// have no effect now. Out: a command; words. It names GLFW's keys and needs no window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

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
    view_front, ///< these six as in `axis_views`
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

/// The modifiers that are held with a key.
struct KeyModifiers {
    bool shift = false;
    bool control = false;
    bool alt = false;

    bool operator==(KeyModifiers const&) const = default;
};

struct KeyMeaning {
    int key; ///< its number in GLFW
    KeyModifiers with;
    Command command;
    bool repeats; ///< it does so again and again while it is held
};

/// The meanings of all keys; each numbered camera has its own.
std::span<KeyMeaning const> key_meanings();

/// The command of a key; nothing where it has none. `held_down`: the key repeats itself. Shift counts only where the
/// table has another meaning with it: which keys want it for a + is the keyboard's business.
std::optional<Command> command_of_key(int key, KeyModifiers with, bool held_down);

/// The keys of a command as they are called on a keyboard: "Space", "Shift+B", "F9"; several are "F2 or Tab".
std::string key_names(Command command);

/// A text followed by the command's keys, as a tooltip says it: "play or pause (Space)".
std::string with_keys(std::string const& what, Command command);

/// The help's words for one command, for the tooltip of what does the same by mouse. All numbered cameras of a kind
/// have the same.
std::string help_text(Command command);

using TextRows = std::vector<std::pair<std::string, std::string>>; ///< name and value

struct HelpGroup {
    std::string title;
    TextRows rows;
    bool operator==(HelpGroup const&) const = default;
};

/// The help that F1 shows: what one needs first comes first. `clock_lacks`: why the keys that set the scene's clock
/// have no effect; empty: they have one.
std::vector<HelpGroup> help_groups(std::string const& clock_lacks);

/// The number of groups that stand on the left where the help has two columns, of which the higher one is as low as can
/// be.
std::size_t left_groups(std::span<HelpGroup const> shown);

/// Text that is shown while the mouse turns the head.
inline constexpr char const* mouse_look_text = "the mouse looks around, W A S D Q E fly; a click or Esc ends it";

/// Text that is shown after an Esc that leaves nothing yet.
std::string escape_note();

} // namespace framelet
