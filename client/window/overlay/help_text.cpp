#include "client/window/overlay/help_text.h"

#include <algorithm>
#include <span>

#include "client/window/overlay/key_table.h"

namespace framelet {

namespace {

struct Line {
    Command command;
    char const* text;
    char const* hands = nullptr; ///< what the hands do, where that is no command
};

constexpr Line by_hand(char const* hands, char const* text) {
    return {Command::quit, text, hands};
}

constexpr Line first[] = {
    by_hand("left drag", "orbit around what is under the pointer"),
    by_hand("wheel or right drag", "nearer, farther"),
    by_hand("middle or Shift+left drag", "pan"),
    by_hand("double click", "look at that point, from half as far"),
    {Command::fit_scene, "the whole scene"},
    {Command::reset, "back to the first view"},
    {Command::screenshot, "screenshot, a PNG in the current folder"},
    {Command::toggle_help, "this help"},
    {Command::escape, "leave mouse look, menu, help, full screen; twice: quit"},
    {Command::quit, "quit at once"},
};
constexpr Line clock[] = {
    {Command::play_or_pause, "play, pause"},     {Command::step_forward, "step on by 1/30 s"},
    {Command::step_back, "step back by 1/30 s"}, {Command::seek_forward, "forward by 1 s"},
    {Command::seek_back, "back by 1 s"},         {Command::seek_start, "animation to its start"},
    {Command::faster, "twice the speed"},        {Command::slower, "half the speed"},
};
constexpr Line flying[] = {
    by_hand("W A S D, Q E", "fly; down, up (Shift: faster)"),
    by_hand("right drag meanwhile", "look around"),
    {Command::mouse_look, "look around with the mouse, wheel: speed"},
    by_hand("gamepad", "sticks: fly, look; triggers: down, up"),
};
constexpr Line views[] = {
    {Command::view_front, "the whole scene from the front"},
    {Command::view_back, "from behind"},
    {Command::view_right, "from the right"},
    {Command::view_left, "from the left"},
    {Command::view_top, "from above"},
    {Command::view_below, "from below"},
    {Command::toggle_projection, "orthographic, or perspective"},
};
constexpr Line cameras[] = {
    by_hand("1 .. 9", "camera of the scene"),
    {Command::free_camera, "leave the camera, go on from there"},
    {Command::add_bookmark, "bookmark this view"},
    by_hand("Shift+1 .. 9", "bookmark"),
    {Command::remove_bookmark, "remove the bookmark gone to last"},
    {Command::copy_camera, "copy this view, its moment and exposure"},
    {Command::paste_camera, "go to the view that was copied"},
    {Command::save_camera, "save it as a camera file, which may be dropped here"},
};
constexpr Line picture[] = {
    {Command::brighter, "brighter by 1/4 EV"},
    {Command::darker, "darker by 1/4 EV"},
    {Command::sharper, "while things move: more detail"},
    {Command::fresher, "while things move: newer pixels"},
    {Command::toggle_smoothing, "smooth motion, the scene a little late, or not"},
    {Command::toggle_recording, "record what is seen, or stop"},
    {Command::screenshot_with_depth, "screenshot as EXR, with depth"},
};
constexpr Line window[] = {
    {Command::open_file, "open a scene file, served by this machine"},
    by_hand("dropping a scene file", "opens it likewise"),
    {Command::toggle_fullscreen, "full screen"},
    {Command::toggle_time_line, "the bar at the lower edge, or not"},
    {Command::toggle_statistics, "statistics"},
    {Command::toggle_details, "details in them"},
    {Command::next_overlay, "draw over it: ages, confidence, refresh-rate, arrivals, holes, none"},
    {Command::toggle_reprojection, "move what is held to where it is now, or not"},
};

struct Group {
    char const* title;
    std::span<Line const> lines;
};
constexpr Group groups[] = {{"To begin with", first}, {"Time", clock},      {"Flying", flying}, {"Views", views},
                            {"Cameras", cameras},     {"Picture", picture}, {"Window", window}};

std::string keys_of(Line const& line) {
    return line.hands != nullptr ? line.hands : key_names(line.command);
}

} // namespace

std::string escape_note() {
    return with_keys("Esc once more quits", Command::quit);
}

std::vector<HelpGroup> help_groups(std::string const& clock_lacks) {
    std::vector<HelpGroup> out;
    for (Group const& group : groups) {
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

std::string help_text(Command command) {
    if (command >= Command::bookmark) {
        return "bookmark";
    }
    if (command >= Command::scene_camera) {
        return "camera of the scene";
    }
    for (Group const& group : groups) {
        for (Line const& line : group.lines) {
            if (line.hands == nullptr && line.command == command) {
                return line.text;
            }
        }
    }
    return "connect"; // where there is no session
}

} // namespace framelet
