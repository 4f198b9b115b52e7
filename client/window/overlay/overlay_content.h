// The content of the overlay, as plain values, and what the mouse and the keyboard did to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/core/drawn_over/drawn_over.h"
#include "client/viewer/commands.h"
#include "client/viewer/legend.h"
#include "client/window/named_server.h"
#include "client/window/overlay/time_line.h"

namespace framelet {

/// A figure, and its course over time.
struct Plot {
    std::string name;
    std::string value; ///< now
    std::vector<float> values; ///< the oldest first; a negative one was not measured
    float whole = 0; ///< the most that it can be; 0: there is no such bound
    bool operator==(Plot const&) const = default;
};

struct StatisticsPanel {
    std::vector<Plot> plots;
    TextRows rows; ///< below the plots
    bool shows_details = false;
    TextRows details;
    bool operator==(StatisticsPanel const&) const = default;
};

/// The name of the view that is neither a camera of the scene nor a bookmark.
inline constexpr char const* free_camera_text = "free camera";

/// The cameras and bookmarks that one can look through.
struct CameraMenu {
    std::string current;
    std::vector<std::string> scene_cameras; ///< names, for people
    std::vector<std::string> bookmarks; ///< their names
    bool operator==(CameraMenu const&) const = default;
};

/// The kinds of overlay that can be drawn over the picture.
struct OverlayMenu {
    DrawnOver current = DrawnOver::nothing;
    std::string confidence_lacks{}; ///< why it is not to be had; empty: it is
    bool operator==(OverlayMenu const&) const = default;
};

/// A name while it is being typed: ImGui keeps the field's text only as long as nothing else is clicked.
struct NameEdit {
    int bookmark = -1; ///< whose name it is; -1: none's
    std::string text{};
};

enum class ServerField : std::uint8_t { none, address, token };
/// Fields in which a server may be named, and its token.
struct AddressField {
    std::string proposed;
    std::vector<std::string> recent;
    ServerField takes_keys = ServerField::none; ///< once it is another than before, without a click into it
    bool always_tls = false; ///< whatever the address says
    bool operator==(AddressField const&) const = default;
};

struct OverlayContent {
    std::vector<HelpGroup> help; ///< empty: not shown
    std::optional<StatisticsPanel> statistics;
    std::optional<Legend> legend;
    std::string sign; ///< small, at the upper edge; empty: none
    std::optional<float> progress; ///< a bar below it, [0, 1]
    std::string note; ///< at the lower edge; empty: none
    std::string message; ///< in the middle; empty: none
    bool asks_trust = false; ///< the message is a question, with two answers below
    std::optional<AddressField> address; ///< below the message
    std::optional<TimeLine> time_line; ///< along the lower edge
    CameraMenu cameras; ///< in that bar
    float bias = 0; ///< shown in that bar; -1: sharp, 1: fresh
    OverlayMenu overlays; ///< likewise
    std::string picture_lacks; ///< why there is nothing to be saved; empty: there is
    bool has_pointer = true; ///< the mouse may be on any of it

    bool operator==(OverlayContent const&) const = default;
    bool empty() const {
        return help.empty() && !statistics && !legend && note.empty() && sign.empty() && message.empty() && !time_line;
    }
};

/// Actions that the hands asked for.
struct OverlayActions {
    std::vector<Command> commands; ///< in order
    std::optional<SceneTime> seek; ///< where the clock is to stand
    std::optional<int> scene_camera; ///< to look through
    std::optional<int> bookmark; ///< to go to
    std::optional<int> removed_bookmark;
    std::optional<DrawnOver> drawn_over;
    struct Renamed {
        int bookmark;
        std::string name;
    };
    std::optional<Renamed> renamed;
    std::optional<NamedServer> server; ///< to connect to
    std::optional<bool> trusts; ///< the answer to the message
};

} // namespace framelet
