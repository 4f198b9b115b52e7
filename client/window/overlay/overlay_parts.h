// The parts of the overlay, each drawn into ImGui's current frame. In: values. Out: what was done to them, and where
// the mouse belongs to them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <imgui.h>

#include "client/window/overlay/overlay_content.h"

namespace framelet {

/// A rectangle in ImGui's coordinates.
struct OverlayArea {
    ImVec2 from, to;
};

/// The state that is collected while a frame is laid out.
struct OverlayFrame {
    OverlayActions& actions;
    std::vector<OverlayArea>& areas;
    NameEdit& edit;
    ServerField had_keys = ServerField::none; ///< the field that took the keys in the last frame
    bool closes_menu = false; ///< a menu that is open is to be closed
    float bar_height = 0; ///< so much of the lower edge is taken, in ImGui's coordinates
    float left_width = 0; ///< so much of the upper edge is taken, from the left
};

/// Gives the mouse in the current window's area to the overlay.
void take_area(OverlayFrame& frame);
/// Gives the last item a tooltip, also where it cannot be used now: that is when one asks why.
void tooltip(std::string const& text);
/// Makes what follows grey until `end_lack`, where something is lacking for it.
void begin_lack(std::string const& lacks);
/// Ends that; the tooltip of the last item says what it does or, where it does nothing, what it lacks.
void end_lack(std::string const& lacks, std::string const& tip);
/// A button and, in its tooltip, what it does; the next thing stands beside it. `lacks`: why it does nothing now.
void button(char const* label, Command command, OverlayFrame& frame, std::string const& lacks = "");
/// The help's words for a command, and its keys.
std::string tip_of(Command command);

/// Draws the bar along the lower edge; sets `bar_height`.
void draw_bar(OverlayContent const& content, OverlayFrame& frame);
void draw_statistics(StatisticsPanel const& panel, OverlayFrame& frame);
void draw_legend(Legend const& legend, OverlayFrame& frame);
void draw_help(std::span<HelpGroup const> groups, OverlayFrame& frame);
/// Draws a panel with a text. `progress`, [0, 1]: a bar below. At the right end of the upper edge it keeps clear of
/// what takes the left one, as far as there is room.
void draw_text(char const* name, ImVec2 anchor, std::string const& text, OverlayFrame const& frame,
               std::optional<float> progress = {});
/// Draws the message and, where there are any, the answers to it or the fields below it. `typed` is their text,
/// kept by the caller.
void draw_message(OverlayContent const& content, NamedServer& typed, OverlayFrame& frame);

} // namespace framelet
