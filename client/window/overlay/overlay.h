// Draws what lies over the picture: help, statistics, messages, the bar. In: what to say, as plain values. Out: drawn
// over the picture (Dear ImGui); what the hands did to it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/window/overlay/overlay_content.h"
#include "common/framelet/tile.h"

struct GLFWwindow;

namespace framelet {

class Overlay {
public:
    /// The window's context must be current, at destruction too.
    explicit Overlay(GLFWwindow* window);
    ~Overlay();
    Overlay(Overlay const&) = delete;
    Overlay& operator=(Overlay const&) = delete;

    /// Draws into the current framebuffer. The hands are looked at meanwhile: what they press and release shows, and
    /// counts, within the next two calls. `scale`: size of the text, 1 for common displays.
    OverlayActions draw(OverlayContent const& content, float scale);
    /// Areas of what was drawn last in which the mouse does something, pixels of the framebuffer.
    std::span<PixelRect const> mouse_areas() const { return mouse_areas_; }
    /// Pixels of the framebuffer at the lower edge over which the bar was drawn last.
    int covered_below() const { return covered_below_; }
    /// True while letters go into a text, and are no commands.
    bool is_typed_into() const;
    /// The server that stands in the fields.
    NamedServer const& server() const { return server_; }
    bool has_menu() const { return has_menu_; }
    /// Closes a menu that is open with the next `draw`.
    void close_menu() { closes_menu_ = true; }

private:
    void set_scale(float scale);
    void lay_out(OverlayContent const& content, OverlayActions& actions);

    float scale_ = 0; ///< of the text; 0: none has been drawn
    OverlayContent drawn_;
    std::vector<PixelRect> mouse_areas_;
    int covered_below_ = 0;
    bool has_menu_ = false;
    bool closes_menu_ = false;
    NameEdit edit_;
    NamedServer server_; ///< as typed
    std::optional<std::string> proposed_; ///< what its field was filled in with at first
    ServerField had_keys_ = ServerField::none; ///< as OverlayFrame's
};

} // namespace framelet
