#include "client/window/overlay/help_text.h"

#include <initializer_list>
#include <span>

#include "client/window/overlay/key_table.h"

namespace framelet {

namespace {

struct Line {
    Command command;
    char const* text;
};

constexpr Line cameras[] = {
    {Command::mouse_look, "look around with the mouse, wheel: speed"},
    {Command::fit_scene, "the whole scene"},
    {Command::reset, "back to the first view"},
    {Command::view_front, "look at it from the front"},
    {Command::view_right, "from the right"},
    {Command::view_top, "from above"},
    {Command::toggle_projection, "orthographic, or perspective"},
    {Command::free_camera, "leave the camera, go on from there"},
    {Command::add_bookmark, "bookmark this view"},
    {Command::remove_bookmark, "remove the bookmark gone to last"},
    {Command::copy_camera, "copy this view as a camera file"},
    {Command::save_camera, "save it as one in the current folder"},
};
constexpr Line clock[] = {
    {Command::play_or_pause, "play, pause"},     {Command::step_forward, "step on by 1/30 s"},
    {Command::step_back, "step back by 1/30 s"}, {Command::seek_forward, "forward by 1 s"},
    {Command::seek_back, "back by 1 s"},         {Command::seek_start, "animation to its start"},
    {Command::faster, "twice the speed"},        {Command::slower, "half the speed"},
};
constexpr Line others[] = {
    {Command::brighter, "brighter by 1/4 EV"},
    {Command::darker, "darker by 1/4 EV"},
    {Command::sharper, "while things move: more detail"},
    {Command::fresher, "while things move: newer pixels"},
    {Command::screenshot, "screenshot, a PNG in the current folder"},
    {Command::screenshot_with_depth, "the same as EXR, with depth"},
    {Command::toggle_recording, "record what is seen, or stop"},
    {Command::toggle_statistics, "statistics"},
    {Command::toggle_details, "details in them"},
    {Command::next_overlay, "draw over it: ages, confidence, refresh-rate, arrivals, holes, none"},
    {Command::toggle_reprojection, "move what is held to where it is now, or not"},
    {Command::toggle_smoothing, "smooth motion, the scene a little late, or not"},
    {Command::toggle_time_line, "the bar at the lower edge, or not"},
    {Command::toggle_fullscreen, "full screen"},
    {Command::toggle_help, "this help"},
    {Command::escape, "leave mouse look, menu, help, full screen; twice: quit"},
    {Command::quit, "quit at once"},
};

void add(TextRows& rows, std::span<Line const> lines) {
    for (Line const& line : lines) {
        rows.emplace_back(key_names(line.command), line.text);
    }
}

} // namespace

std::string escape_note() {
    return with_keys("Esc once more quits", Command::quit);
}

TextRows help_rows(std::string const& clock_lacks) {
    TextRows rows{
        {"left drag", "orbit around what is under the pointer"},
        {"middle or Shift+left drag", "pan"},
        {"wheel or right drag", "nearer, farther"},
        {"double click", "look at that point, from half as far"},
        {"W A S D, Q E", "fly; down, up (Shift: faster)"},
        {"right drag meanwhile", "look around"},
        {"gamepad", "sticks: fly, look; triggers: down, up"},
        {"dropping a scene file", "opens it here, served by this machine"},
        {"1 .. 9", help_text(Command::scene_camera)},
        {"Shift+1 .. 9", help_text(Command::bookmark)},
    };
    add(rows, cameras);
    if (clock_lacks.empty()) {
        add(rows, clock);
    } else {
        std::string keys;
        for (Line const& line : clock) {
            keys += (keys.empty() ? "" : " ") + key_names(line.command);
        }
        rows.emplace_back(keys, clock_lacks);
    }
    add(rows, others);
    return rows;
}

std::string help_text(Command command) {
    if (command >= Command::bookmark) {
        return "bookmark";
    }
    if (command >= Command::scene_camera) {
        return "camera of the scene";
    }
    for (std::span<Line const> const lines :
         {std::span<Line const>(cameras), std::span<Line const>(clock), std::span<Line const>(others)}) {
        for (Line const& line : lines) {
            if (line.command == command) {
                return line.text;
            }
        }
    }
    return "connect"; // where there is no session
}

} // namespace framelet
