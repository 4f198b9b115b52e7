#include "client/viewer/commands.h"

#include <algorithm>
#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace framelet {

namespace {

struct Key {
    int number; ///< in GLFW; 0: none
    KeyModifiers with{};
};

constexpr Key shift(int number) {
    return {number, {.shift = true}};
}
constexpr Key control(int number) {
    return {number, {.control = true}};
}
constexpr Key alt(int number) {
    return {number, {.alt = true}};
}

/// A line of the help: a command, or what is done otherwise, as with the mouse.
struct Line {
    char const* hands; ///< what they do; null where it is a command
    std::optional<Command> command;
    std::array<Key, 2> keys; ///< each stands for it
    char const* text;
    bool repeats = false; ///< while the key is held
    int count = 1; ///< so many keys from this one on stand for so many commands from this one on
};

constexpr Line by_hand(char const* hands, char const* text) {
    return {hands, std::nullopt, {}, text};
}
constexpr Line by_key(Command command, Key key, char const* text) {
    return {nullptr, command, {key}, text};
}
constexpr Line by_key(Command command, Key key, Key other, char const* text) {
    return {nullptr, command, {key, other}, text};
}
constexpr Line by_held_key(Command command, Key key, char const* text) {
    return {nullptr, command, {key}, text, true};
}
constexpr Line by_number(Command first, Key key, char const* text) {
    return {nullptr, first, {key}, text, false, numbered_cameras};
}

constexpr Line first[] = {
    by_hand("left drag", "orbit around what is under the pointer"),
    by_hand("wheel or right drag", "nearer, farther"),
    by_hand("middle or Shift+left drag", "pan"),
    by_hand("double click", "look at that point, from half as far"),
    by_key(Command::fit_scene, {GLFW_KEY_F}, "the whole scene"),
    by_key(Command::reset, {GLFW_KEY_R}, "back to the first view"),
    by_key(Command::screenshot, {GLFW_KEY_F12}, "screenshot, a PNG in the current folder"),
    by_key(Command::toggle_help, {GLFW_KEY_F1}, "this help"),
    by_key(Command::escape, {GLFW_KEY_ESCAPE}, "leave mouse look, menu, help, full screen; twice: quit"),
    by_key(Command::quit, control(GLFW_KEY_Q), "quit at once"),
};
constexpr Line clock[] = {
    by_key(Command::play_or_pause, {GLFW_KEY_SPACE}, "play, pause"),
    by_held_key(Command::step_forward, {GLFW_KEY_PERIOD}, "step on by 1/30 s"),
    by_held_key(Command::step_back, {GLFW_KEY_COMMA}, "step back by 1/30 s"),
    by_held_key(Command::seek_forward, {GLFW_KEY_RIGHT}, "forward by 1 s"),
    by_held_key(Command::seek_back, {GLFW_KEY_LEFT}, "back by 1 s"),
    by_key(Command::seek_start, {GLFW_KEY_HOME}, "animation to its start"),
    by_key(Command::faster, {GLFW_KEY_EQUAL}, {GLFW_KEY_KP_ADD}, "twice the speed"),
    by_key(Command::slower, {GLFW_KEY_MINUS}, {GLFW_KEY_KP_SUBTRACT}, "half the speed"),
};
constexpr Line flying[] = {
    by_hand("W A S D, Q E", "fly; down, up (Shift: faster)"),
    by_hand("right drag meanwhile", "look around"),
    by_key(Command::mouse_look, {GLFW_KEY_M}, "look around with the mouse, wheel: speed"),
    by_hand("gamepad", "sticks: fly, look; triggers: down, up"),
};
constexpr Line views[] = {
    by_key(Command::view_front, {GLFW_KEY_KP_1}, "the whole scene from the front"),
    by_key(Command::view_back, control(GLFW_KEY_KP_1), "from behind"),
    by_key(Command::view_right, {GLFW_KEY_KP_3}, "from the right"),
    by_key(Command::view_left, control(GLFW_KEY_KP_3), "from the left"),
    by_key(Command::view_top, {GLFW_KEY_KP_7}, "from above"),
    by_key(Command::view_below, control(GLFW_KEY_KP_7), "from below"),
    by_key(Command::toggle_projection, {GLFW_KEY_KP_5}, "orthographic, or perspective"),
};
constexpr Line cameras[] = {
    by_number(Command::scene_camera, {GLFW_KEY_1}, "camera of the scene"),
    by_key(Command::free_camera, {GLFW_KEY_0}, "leave the camera, go on from there"),
    by_key(Command::add_bookmark, {GLFW_KEY_B}, "bookmark this view"),
    by_number(Command::bookmark, shift(GLFW_KEY_1), "bookmark"),
    by_key(Command::remove_bookmark, shift(GLFW_KEY_B), "remove the bookmark gone to last"),
    by_key(Command::copy_camera, {GLFW_KEY_C}, control(GLFW_KEY_C), "copy this view, its moment and exposure"),
    by_key(Command::paste_camera, {GLFW_KEY_V}, control(GLFW_KEY_V), "go to the view that was copied"),
    by_key(Command::save_camera, shift(GLFW_KEY_C), "save it as a camera file, which may be dropped here"),
};
constexpr Line picture[] = {
    by_held_key(Command::brighter, {GLFW_KEY_RIGHT_BRACKET}, "brighter by 1/4 EV"),
    by_held_key(Command::darker, {GLFW_KEY_LEFT_BRACKET}, "darker by 1/4 EV"),
    by_held_key(Command::sharper, {GLFW_KEY_K}, "while things move: more detail"),
    by_held_key(Command::fresher, {GLFW_KEY_L}, "while things move: newer pixels"),
    by_key(Command::toggle_smoothing, {GLFW_KEY_F5}, "smooth motion, the scene a little late, or not"),
    by_key(Command::toggle_recording, {GLFW_KEY_F9}, "record what is seen, or stop"),
    by_key(Command::screenshot_with_depth, shift(GLFW_KEY_F12), "screenshot as EXR, with depth"),
};
constexpr Line window[] = {
    by_key(Command::open_file, control(GLFW_KEY_O), "open a scene file, served by this machine"),
    by_hand("dropping a scene file", "opens it likewise"),
    by_key(Command::toggle_fullscreen, {GLFW_KEY_F11}, alt(GLFW_KEY_ENTER), "full screen"),
    by_key(Command::toggle_time_line, {GLFW_KEY_F6}, "the bar at the lower edge, or not"),
    by_key(Command::toggle_statistics, {GLFW_KEY_F2}, {GLFW_KEY_TAB}, "statistics"),
    by_key(Command::toggle_details, {GLFW_KEY_F7}, "details in them"),
    by_key(Command::next_overlay, {GLFW_KEY_F3}, "draw over it: ages, confidence, refresh-rate, arrivals, holes, none"),
    by_key(Command::toggle_reprojection, {GLFW_KEY_F4}, "move what is held to where it is now, or not"),
};
constexpr Line told_where_it_can_be_done[] = {
    by_key(Command::reconnect, {GLFW_KEY_ENTER}, {GLFW_KEY_KP_ENTER}, "connect"),
};

struct Group {
    char const* title; ///< null: it is not in the help
    std::span<Line const> lines;
};
constexpr Group groups[] = {
    {"To begin with", first}, {"Time", clock},      {"Flying", flying}, {"Views", views},
    {"Cameras", cameras},     {"Picture", picture}, {"Window", window}, {nullptr, told_where_it_can_be_done}};

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

std::vector<KeyMeaning> meanings_of_all_keys() {
    std::vector<KeyMeaning> out;
    for (Group const& group : groups) {
        for (Line const& line : group.lines) {
            for (Key const& key : line.keys) {
                for (int i = 0; i < line.count && line.command && key.number != 0; ++i) {
                    out.push_back({key.number + i, key.with, numbered(*line.command, i), line.repeats});
                }
            }
        }
    }
    return out;
}

std::string keys_of(Line const& line) {
    std::string const names = line.hands != nullptr ? line.hands : key_names(*line.command);
    return line.count > 1 ? names + " .. " + std::to_string(line.count) : names;
}

} // namespace

std::span<KeyMeaning const> key_meanings() {
    static std::vector<KeyMeaning> const all = meanings_of_all_keys();
    return all;
}

std::optional<Command> command_of_key(int key, KeyModifiers with, bool held_down) {
    auto const all = key_meanings();
    auto const find = [&](KeyModifiers wanted) {
        return std::ranges::find_if(all, [&](KeyMeaning const& m) { return m.key == key && m.with == wanted; });
    };
    auto found = find(with);
    if (found == all.end() && with == KeyModifiers{.shift = true}) {
        found = find({});
    }
    if (found == all.end() || (held_down && !found->repeats)) {
        return std::nullopt;
    }
    return found->command;
}

std::string key_names(Command command) {
    std::string out;
    for (KeyMeaning const& meaning : key_meanings()) {
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

std::string help_text(Command command) {
    for (Group const& group : groups) {
        for (Line const& line : group.lines) {
            if (line.command && command >= *line.command && command < numbered(*line.command, line.count)) {
                return line.text;
            }
        }
    }
    return {};
}

std::vector<HelpGroup> help_groups(std::string const& clock_lacks) {
    std::vector<HelpGroup> out;
    for (Group const& group : groups) {
        if (group.title == nullptr) {
            continue;
        }
        HelpGroup& added = out.emplace_back(HelpGroup{group.title, {}});
        if (group.lines.data() == clock && !clock_lacks.empty()) {
            std::string keys;
            for (Line const& line : group.lines) {
                keys += (keys.empty() ? "" : " ") + keys_of(line);
            }
            added.rows.emplace_back(keys, clock_lacks);
            continue;
        }
        for (Line const& line : group.lines) {
            added.rows.emplace_back(keys_of(line), line.text);
        }
    }
    return out;
}

std::size_t left_groups(std::span<HelpGroup const> shown) {
    std::size_t right = 0;
    for (HelpGroup const& group : shown) {
        right += group.rows.size() + 1;
    }
    std::size_t out = 0, left = 0, least = right;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        left += shown[i].rows.size() + 1;
        right -= shown[i].rows.size() + 1;
        if (std::max(left, right) <= least) {
            least = std::max(left, right);
            out = i + 1;
        }
    }
    return out;
}

std::string escape_note() {
    return with_keys("Esc once more quits", Command::quit);
}

} // namespace framelet
