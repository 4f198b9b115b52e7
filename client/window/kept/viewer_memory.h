// The settings that the window remembers from one run to the next. In and out: a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/camera.h"

namespace framelet {

struct ViewerMemory {
    std::optional<Viewport> size; ///< of the window, not of a full screen
    bool fullscreen = false;
    bool shows_statistics = false;
    bool shows_details = false;
    bool shows_bar = true;
    std::vector<std::string> servers; ///< as `ConnectionOptions::server_name`, the newest first
    // What was set by hand in the window; options of the command line go before it, and are not remembered.
    float bias = 0; ///< as in ViewerSettings
    double lag_seconds = 0; ///< as in `ClientCore::set_smoothing`
    float fly_speed = 1; ///< as `CameraController::speed_factor`

    bool operator==(ViewerMemory const&) const = default;

    static constexpr std::size_t most_servers = 8;
    /// Makes this server the newest.
    void note_server(std::string const& address);
};

/// Reads the text of the file; what is missing or makes no sense is as if nothing had been remembered.
ViewerMemory parse_viewer_memory(std::string const& text);

/// Reads framelet/viewer.json where state is kept; a file that cannot be read is as none.
ViewerMemory read_viewer_memory();
/// Writes that file. What cannot be written is forgotten: it is not worth a message.
void write_viewer_memory(ViewerMemory const& memory);

} // namespace framelet
