// Text over the picture: help, statistics, messages. In: what to say, as plain values. Out: drawn over the picture
// (Dear ImGui).
#pragma once

#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace framelet {

using TextRows = std::vector<std::pair<std::string, std::string>>; ///< name and value

struct OverlayContent {
    TextRows help; ///< empty: not shown
    TextRows statistics; ///< empty: not shown
    std::string sign; ///< small, at the upper edge; empty: none
    std::string note; ///< at the lower edge; empty: none
    std::string message; ///< in the middle; empty: none

    bool operator==(OverlayContent const&) const = default;
    bool empty() const { return help.empty() && statistics.empty() && note.empty() && sign.empty() && message.empty(); }
};

class Overlay {
public:
    /// The window's context must be current, at destruction too. `scale`: size of the text, 1 for common displays.
    Overlay(GLFWwindow* window, float scale);
    ~Overlay();
    Overlay(Overlay const&) = delete;
    Overlay& operator=(Overlay const&) = delete;

    /// Into the current framebuffer.
    void draw(OverlayContent const& content);

private:
    OverlayContent drawn_;
};

} // namespace framelet
