// The parts of the overlay, each drawn into ImGui's current frame. In: values. Out: what was done to them, and where
// the mouse belongs to them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

#include "client/window/overlay/overlay_content.h"

namespace framelet {

/// Rectangles of ImGui's coordinates.
struct OverlayArea {
    ImVec2 from, to;
};

/// What is collected while a frame is laid out.
struct OverlayFrame {
    OverlayActions& actions;
    std::vector<OverlayArea>& areas;
    NameEdit& edit;
    bool closes_menu = false; ///< one that is open is to be closed
    float bar_height = 0; ///< so much of the lower edge is taken
    float left_width = 0; ///< and of the upper one, from the left
};

/// What the mouse does on it.
enum class PanelKind {
    told, ///< nothing
    takes_mouse,
    scrolls, ///< its wheel, where there is more of it than room
};

/// A panel whose own point `anchor` (0..1) lies at that point of the window, a margin away from the edges and from the
/// bar. `ImGui::End` after it, whatever it returns.
bool begin_panel(char const* name, ImVec2 anchor, float opacity, OverlayFrame const& frame,
                 PanelKind kind = PanelKind::told);
/// The current window's place is the overlay's.
void take_area(OverlayFrame& frame);
/// Also of what cannot be used now: that is when one asks why.
void tooltip(std::string const& text);
/// A button and, in its tooltip, what it does; the next thing stands beside it.
void button(char const* label, Command command, std::string const& tip, OverlayFrame& frame);

/// Along the lower edge; sets `bar_height`.
void draw_bar(OverlayContent const& content, OverlayFrame& frame);
/// What one can look through, a menu of the bar.
void draw_camera_menu(CameraMenu const& menu, OverlayFrame& frame);
void draw_statistics(StatisticsPanel const& panel, OverlayFrame& frame);
void draw_legend(Legend const& legend, OverlayFrame& frame);
void draw_help(TextRows const& rows, OverlayFrame& frame);
/// `progress`, [0, 1]: a bar below. At the right end of the upper edge it keeps clear of what takes the left one, as
/// far as there is room.
void draw_text(char const* name, ImVec2 anchor, std::string const& text, OverlayFrame const& frame,
               std::optional<float> progress = {});
/// `typed` is the field's text, kept by the caller.
void draw_message(std::string const& text, AddressField const* field, std::string& typed, OverlayFrame& frame);

} // namespace framelet
