// What lies over the picture: help, statistics, messages, the time line. In: what to say, as plain values. Out: drawn
// over the picture (Dear ImGui); what the mouse did to the time line.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/window/command.h"
#include "client/window/time_line.h"
#include "common/tile.h"

struct GLFWwindow;

namespace framelet {

using TextRows = std::vector<std::pair<std::string, std::string>>; ///< name and value

struct OverlayContent {
    TextRows help; ///< empty: not shown
    TextRows statistics; ///< empty: not shown
    std::string sign; ///< small, at the upper edge; empty: none
    std::string note; ///< at the lower edge; empty: none
    std::string message; ///< in the middle; empty: none
    std::optional<TimeLine> time_line; ///< along the lower edge

    bool operator==(OverlayContent const&) const = default;
    bool empty() const {
        return help.empty() && statistics.empty() && note.empty() && sign.empty() && message.empty() && !time_line;
    }
};

/// What the mouse asked for.
struct OverlayActions {
    std::vector<Command> commands; ///< in order
    std::optional<SceneTime> seek; ///< where the clock is to stand
};

class Overlay {
public:
    /// The window's context must be current, at destruction too. `scale`: size of the text, 1 for common displays.
    Overlay(GLFWwindow* window, float scale);
    ~Overlay();
    Overlay(Overlay const&) = delete;
    Overlay& operator=(Overlay const&) = delete;

    /// Into the current framebuffer. The mouse is looked at meanwhile: what it presses and releases shows, and counts,
    /// within the next two calls.
    OverlayActions draw(OverlayContent const& content);
    /// Of what was drawn last: where the mouse does something. Pixels of the framebuffer.
    PixelRect const& mouse_area() const { return mouse_area_; }

private:
    void lay_out(OverlayContent const& content, OverlayActions& actions);

    OverlayContent drawn_;
    PixelRect mouse_area_{};
};

} // namespace framelet
