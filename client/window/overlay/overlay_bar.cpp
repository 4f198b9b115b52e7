#include "client/window/overlay/overlay_parts.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "client/viewer/commands.h"
#include "client/viewer/lacks.h"
#include "client/window/overlay/overlay_text.h"

namespace framelet {

namespace {

void label(char const* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine();
}

template <class... Values>
std::string formatted(char const* format, Values... values) {
    char text[64];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

constexpr char const* shown_buttons[] = {"photo", "rec", "stats", "?"};

/// Widths of the window, in font sizes, from which on the bar has these controls; in smaller ones keys do the same.
constexpr float room_for_bias = 74;
constexpr float room_for_exposure = 61;
constexpr float room_for_speed = 51;
constexpr float room_for_overlays = 42;

bool has_room(float for_it) {
    return ImGui::GetIO().DisplaySize.x > for_it * ImGui::GetFontSize();
}

/// Width of the list of overlays, with room for the longest name; pixels.
float overlays_width() {
    float width = 0;
    for (char const* const name : drawn_over_names) {
        width = std::max(width, ImGui::CalcTextSize(name).x);
    }
    return width + 2 * ImGui::GetStyle().FramePadding.x;
}

/// Width of what stands to the right of the time line, pixels. `moves`: the speed of the clock is among it.
float right_width(bool moves) {
    ImGuiStyle const& style = ImGui::GetStyle();
    auto const width_of = [&](char const* text) { return ImGui::CalcTextSize(text).x + style.ItemSpacing.x; };
    auto const width_of_button = [&](char const* text) { return width_of(text) + 2 * style.FramePadding.x; };
    float const plus_and_minus = 2 * width_of_button("+");
    float width = moves && has_room(room_for_speed) ? plus_and_minus + width_of("0.0625x") : 0;
    width += has_room(room_for_exposure) ? plus_and_minus + width_of("-16.00 EV") : 0;
    width += has_room(room_for_bias) ? width_of_button("sharp") + width_of("+0.00") + width_of_button("fresh") : 0;
    width += has_room(room_for_overlays) ? overlays_width() + style.ItemSpacing.x : 0;
    for (char const* const text : shown_buttons) {
        width += width_of_button(text);
    }
    return width;
}

void clock_controls(TimeLine const& line, OverlayFrame& frame) {
    std::string const& lacks = line.fixed_because;
    button("|<", Command::seek_start, frame, lacks);
    button("<", Command::step_back, frame, lacks);
    button(line.clock.playing ? "pause###play" : "play ###play", Command::play_or_pause, frame, lacks);
    button(">", Command::step_forward, frame, lacks);
    SceneTime time = line.clock.time;
    SceneTime const begin = line.round_begin();
    SceneTime const end = line.round_end();
    float const width = std::max(ImGui::GetContentRegionAvail().x - right_width(true), 5 * ImGui::GetFontSize());
    std::string const both = formatted("%.2f s (every %.2f s)", end, line.duration);
    bool const has_room_for_both = ImGui::CalcTextSize(both.c_str()).x < width;
    std::string const format =
        has_room_for_both ? formatted("%%.2f s (every %.2f s)", line.duration) : std::string("%.2f s");
    ImGui::SetNextItemWidth(width);
    begin_lack(lacks);
    if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &time, &begin, &end, format.c_str(),
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
        frame.actions.seek = time;
    }
    end_lack(lacks, "the scene's clock, in this round of the longest clip: drag, or Left and Right for a second");
    ImGui::SameLine();
    if (has_room(room_for_speed)) {
        button("-##speed", Command::slower, frame, lacks);
        label(formatted("%gx", static_cast<double>(line.clock.speed)).c_str());
        button("+##speed", Command::faster, frame, lacks);
    }
}

/// Ends the edit: what was typed becomes the bookmark's name, unless it is cancelled.
void end_edit(bool is_cancelled, OverlayFrame& frame) {
    NameEdit const edit = std::exchange(frame.edit, NameEdit());
    if (edit.bookmark >= 0 && !is_cancelled) {
        frame.actions.renamed = {edit.bookmark, edit.text};
    }
}

/// Draws the row of one bookmark: going there, its name, taking it away.
void bookmark_row(int number, std::string const& name, OverlayFrame& frame) {
    ImGui::PushID(number);
    if (ImGui::Button("go")) {
        frame.actions.bookmark = number;
        ImGui::CloseCurrentPopup();
    }
    tooltip(number < numbered_cameras ? with_keys("go there", numbered(Command::bookmark, number)) : "go there");
    ImGui::SameLine();
    NameEdit& edit = frame.edit;
    std::string const& shown = edit.bookmark == number ? edit.text : name;
    std::array<char, 64> text{};
    std::copy_n(shown.begin(), std::min(shown.size(), text.size() - 1), text.begin());
    ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
    ImGui::InputText("##name", text.data(), text.size());
    if (ImGui::IsItemActive()) {
        edit = {number, text.data()};
    } else if (edit.bookmark == number) {
        end_edit(ImGui::IsKeyDown(ImGui::GetKeyIndex(ImGuiKey_Escape)), frame);
    }
    tooltip("its name: click to change it");
    ImGui::SameLine();
    if (ImGui::Button("x")) {
        frame.actions.removed_bookmark = number;
    }
    tooltip("remove this bookmark");
    ImGui::PopID();
}

/// Draws the bar's menu of what one can look through.
void draw_camera_menu(CameraMenu const& menu, OverlayFrame& frame) {
    float const font = ImGui::GetFontSize();
    float const least = ImGui::CalcTextSize(free_camera_text).x + 2 * ImGui::GetStyle().FramePadding.x;
    float const width = std::max(std::min(ImGui::GetIO().DisplaySize.x / 10, 9 * font), least);
    if (ImGui::Button((menu.current + "###camera").c_str(), ImVec2(width, 0))) {
        ImGui::OpenPopup("cameras");
    }
    tooltip("what one looks through: cameras of the scene (1 .. 9), bookmarks of your own (Shift+1 .. 9)");
    ImGui::SameLine();
    if (!ImGui::BeginPopup("cameras")) {
        end_edit(false, frame); // the menu was closed by a click beside it
        return;
    }
    if (frame.closes_menu) {
        ImGui::CloseCurrentPopup();
    }
    if (ImGui::Selectable(free_camera_text)) {
        frame.actions.commands.push_back(Command::free_camera);
    }
    tooltip(tip_of(Command::free_camera));
    if (ImGui::Selectable("fly with the mouse")) {
        frame.actions.commands.push_back(Command::mouse_look);
    }
    tooltip(tip_of(Command::mouse_look));
    if (std::string const lacks = scene_cameras_lack(menu.scene_cameras.size()); !lacks.empty()) {
        begin_lack(lacks);
        ImGui::Selectable("cameras of the scene");
        end_lack(lacks, "");
    }
    for (std::size_t i = 0; i < menu.scene_cameras.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(menu.scene_cameras[i].c_str())) {
            frame.actions.scene_camera = static_cast<int>(i);
        }
        tooltip(i < numbered_cameras ? tip_of(numbered(Command::scene_camera, static_cast<int>(i)))
                                     : help_text(Command::scene_camera));
        ImGui::PopID();
    }
    ImGui::Separator();
    for (Command const command : {Command::view_front, Command::view_back, Command::view_right, Command::view_left,
                                  Command::view_top, Command::view_below, Command::toggle_projection}) {
        if (ImGui::Selectable(tip_of(command).c_str(), false, ImGuiSelectableFlags_DontClosePopups)) {
            frame.actions.commands.push_back(command);
        }
    }
    ImGui::Separator();
    ImGui::PushID("bookmarks");
    for (std::size_t i = 0; i < menu.bookmarks.size(); ++i) {
        bookmark_row(static_cast<int>(i), menu.bookmarks[i], frame);
    }
    ImGui::PopID();
    for (Command const command :
         {Command::add_bookmark, Command::copy_camera, Command::paste_camera, Command::save_camera}) {
        if (ImGui::Selectable(tip_of(command).c_str(), false, ImGuiSelectableFlags_DontClosePopups)) {
            frame.actions.commands.push_back(command);
        }
    }
    ImGui::EndPopup();
}

/// Draws the bar's list of what can be drawn over the picture.
void draw_overlay_menu(OverlayMenu const& menu, OverlayFrame& frame) {
    ImGui::SetNextItemWidth(overlays_width());
    char const* const shown = menu.current == DrawnOver::nothing ? "overlay" : name_of(menu.current);
    if (!ImGui::BeginCombo("##overlays", shown, ImGuiComboFlags_NoArrowButton)) {
        tooltip(with_keys(overlay_tip(menu.current), Command::next_overlay));
    } else {
        if (frame.closes_menu) {
            ImGui::CloseCurrentPopup();
        }
        for (std::size_t i = 0; i < drawn_over_names.size(); ++i) {
            auto const kind = static_cast<DrawnOver>(i);
            std::string const lacks = kind == DrawnOver::confidence ? menu.confidence_lacks : "";
            begin_lack(lacks);
            if (ImGui::Selectable(name_of(kind), kind == menu.current)) {
                frame.actions.drawn_over = kind;
            }
            end_lack(lacks, overlay_tip(kind));
        }
        ImGui::EndCombo();
    }
    ImGui::SameLine();
}

} // namespace

void draw_bar(OverlayContent const& content, OverlayFrame& frame) {
    TimeLine const& line = *content.time_line;
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGuiStyle const& style = ImGui::GetStyle();
    frame.bar_height = ImGui::GetFrameHeight() + 2 * style.WindowPadding.y;
    ImGui::SetNextWindowPos(ImVec2(0, size.y - frame.bar_height));
    ImGui::SetNextWindowSize(ImVec2(size.x, frame.bar_height));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin("time line", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoScrollWithMouse);
    take_area(frame);
    draw_camera_menu(content.cameras, frame);
    if (line.duration > 0) {
        clock_controls(line, frame);
    } else { // what stands at the right end does so in every scene
        float const room = ImGui::GetContentRegionAvail().x - right_width(false);
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(room, 0.0f));
    }
    if (has_room(room_for_exposure)) {
        button("-##exposure", Command::darker, frame);
        label(formatted("%+.2f EV", static_cast<double>(line.exposure_ev)).c_str());
        button("+##exposure", Command::brighter, frame);
    }
    if (has_room(room_for_bias)) {
        button("sharp", Command::sharper, frame);
        label(formatted("%+.2f", static_cast<double>(content.bias)).c_str());
        button("fresh", Command::fresher, frame);
    }
    if (has_room(room_for_overlays)) {
        draw_overlay_menu(content.overlays, frame);
    }
    constexpr Command shown_commands[] = {Command::screenshot, Command::toggle_recording, Command::toggle_statistics,
                                          Command::toggle_help};
    for (std::size_t i = 0; i < std::size(shown_commands); ++i) {
        bool const saves = shown_commands[i] == Command::screenshot || shown_commands[i] == Command::toggle_recording;
        button(shown_buttons[i], shown_commands[i], frame, saves ? content.picture_lacks : "");
    }
    ImGui::End();
}

} // namespace framelet
