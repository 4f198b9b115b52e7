#include "client/window/overlay/key_table.h"

#include <algorithm>
#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace framelet {

namespace {

constexpr KeyModifiers alone{};
constexpr KeyModifiers shift{.shift = true};
constexpr KeyModifiers control{.control = true};
constexpr KeyModifiers alt{.alt = true};

constexpr std::array unnumbered{
    KeyMeaning{GLFW_KEY_Q, control, Command::quit, false},
    KeyMeaning{GLFW_KEY_ESCAPE, alone, Command::escape, false},
    KeyMeaning{GLFW_KEY_R, alone, Command::reset, false},
    KeyMeaning{GLFW_KEY_ENTER, alone, Command::reconnect, false},
    KeyMeaning{GLFW_KEY_KP_ENTER, alone, Command::reconnect, false},
    KeyMeaning{GLFW_KEY_O, control, Command::open_file, false},
    KeyMeaning{GLFW_KEY_SPACE, alone, Command::play_or_pause, false},
    KeyMeaning{GLFW_KEY_PERIOD, alone, Command::step_forward, true},
    KeyMeaning{GLFW_KEY_COMMA, alone, Command::step_back, true},
    KeyMeaning{GLFW_KEY_HOME, alone, Command::seek_start, false},
    KeyMeaning{GLFW_KEY_RIGHT, alone, Command::seek_forward, true},
    KeyMeaning{GLFW_KEY_LEFT, alone, Command::seek_back, true},
    KeyMeaning{GLFW_KEY_EQUAL, alone, Command::faster, false},
    KeyMeaning{GLFW_KEY_KP_ADD, alone, Command::faster, false},
    KeyMeaning{GLFW_KEY_MINUS, alone, Command::slower, false},
    KeyMeaning{GLFW_KEY_KP_SUBTRACT, alone, Command::slower, false},
    KeyMeaning{GLFW_KEY_RIGHT_BRACKET, alone, Command::brighter, true},
    KeyMeaning{GLFW_KEY_LEFT_BRACKET, alone, Command::darker, true},
    KeyMeaning{GLFW_KEY_K, alone, Command::sharper, true},
    KeyMeaning{GLFW_KEY_L, alone, Command::fresher, true},
    KeyMeaning{GLFW_KEY_0, alone, Command::free_camera, false},
    KeyMeaning{GLFW_KEY_M, alone, Command::mouse_look, false},
    KeyMeaning{GLFW_KEY_F, alone, Command::fit_scene, false},
    KeyMeaning{GLFW_KEY_KP_1, alone, Command::view_front, false},
    KeyMeaning{GLFW_KEY_KP_1, control, Command::view_back, false},
    KeyMeaning{GLFW_KEY_KP_3, alone, Command::view_right, false},
    KeyMeaning{GLFW_KEY_KP_3, control, Command::view_left, false},
    KeyMeaning{GLFW_KEY_KP_7, alone, Command::view_top, false},
    KeyMeaning{GLFW_KEY_KP_7, control, Command::view_below, false},
    KeyMeaning{GLFW_KEY_KP_5, alone, Command::toggle_projection, false},
    KeyMeaning{GLFW_KEY_B, alone, Command::add_bookmark, false},
    KeyMeaning{GLFW_KEY_B, shift, Command::remove_bookmark, false},
    KeyMeaning{GLFW_KEY_C, alone, Command::copy_camera, false},
    KeyMeaning{GLFW_KEY_C, control, Command::copy_camera, false},
    KeyMeaning{GLFW_KEY_V, alone, Command::paste_camera, false},
    KeyMeaning{GLFW_KEY_V, control, Command::paste_camera, false},
    KeyMeaning{GLFW_KEY_C, shift, Command::save_camera, false},
    KeyMeaning{GLFW_KEY_F1, alone, Command::toggle_help, false},
    KeyMeaning{GLFW_KEY_F2, alone, Command::toggle_statistics, false},
    KeyMeaning{GLFW_KEY_TAB, alone, Command::toggle_statistics, false},
    KeyMeaning{GLFW_KEY_F7, alone, Command::toggle_details, false},
    KeyMeaning{GLFW_KEY_F3, alone, Command::next_overlay, false},
    KeyMeaning{GLFW_KEY_F4, alone, Command::toggle_reprojection, false},
    KeyMeaning{GLFW_KEY_F5, alone, Command::toggle_smoothing, false},
    KeyMeaning{GLFW_KEY_F6, alone, Command::toggle_time_line, false},
    KeyMeaning{GLFW_KEY_F9, alone, Command::toggle_recording, false},
    KeyMeaning{GLFW_KEY_F12, alone, Command::screenshot, false},
    KeyMeaning{GLFW_KEY_F12, shift, Command::screenshot_with_depth, false},
    KeyMeaning{GLFW_KEY_F11, alone, Command::toggle_fullscreen, false},
    KeyMeaning{GLFW_KEY_ENTER, alt, Command::toggle_fullscreen, false},
};

constexpr auto all_meanings = [] {
    std::array<KeyMeaning, unnumbered.size() + 2 * numbered_cameras> out{};
    auto next = std::copy(unnumbered.begin(), unnumbered.end(), out.begin());
    for (int i = 0; i < numbered_cameras; ++i) {
        *next++ = {GLFW_KEY_1 + i, alone, numbered(Command::scene_camera, i), false};
        *next++ = {GLFW_KEY_1 + i, shift, numbered(Command::bookmark, i), false};
    }
    return out;
}();

std::string name_of_key(int key) {
    switch (key) {
    case GLFW_KEY_ESCAPE:
        return "Esc";
    case GLFW_KEY_ENTER:
        return "Enter";
    case GLFW_KEY_SPACE:
        return "Space";
    case GLFW_KEY_HOME:
        return "Home";
    case GLFW_KEY_RIGHT:
        return "Right";
    case GLFW_KEY_LEFT:
        return "Left";
    case GLFW_KEY_TAB:
        return "Tab";
    case GLFW_KEY_EQUAL: // it is pressed for a +, with Shift on many keyboards
        return "+";
    default:
        break;
    }
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) {
        return "Num " + std::to_string(key - GLFW_KEY_KP_0);
    }
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25) {
        return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
    }
    return std::string(1, static_cast<char>(key)); // GLFW numbers the others as ASCII does
}

/// True for keys of the keypad that are no digits: they do what their like on the main block does, and are not named.
bool has_a_double(int key) {
    return key >= GLFW_KEY_KP_DECIMAL && key <= GLFW_KEY_KP_EQUAL;
}

} // namespace

std::span<KeyMeaning const> key_meanings() {
    return all_meanings;
}

std::optional<Command> command_of_key(int key, KeyModifiers with, bool held_down) {
    auto const find = [&](KeyModifiers wanted) {
        return std::ranges::find_if(all_meanings,
                                    [&](KeyMeaning const& m) { return m.key == key && m.with == wanted; });
    };
    auto found = find(with);
    if (found == all_meanings.end() && with == shift) {
        found = find(alone);
    }
    if (found == all_meanings.end() || (held_down && !found->repeats)) {
        return std::nullopt;
    }
    return found->command;
}

std::string key_names(Command command) {
    std::string out;
    for (KeyMeaning const& meaning : all_meanings) {
        if (meaning.command != command || has_a_double(meaning.key)) {
            continue;
        }
        out += out.empty() ? "" : " or ";
        out += meaning.with.alt ? "Alt+" : meaning.with.control ? "Ctrl+" : meaning.with.shift ? "Shift+" : "";
        out += name_of_key(meaning.key);
    }
    return out;
}

std::string with_keys(std::string const& what, Command command) {
    std::string const keys = key_names(command);
    return keys.empty() ? what : what + " (" + keys + ")";
}

} // namespace framelet
