// What the window remembers from one run to the next. In and out: a file.
#pragma once

#include <filesystem>
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
    std::vector<std::string> servers; ///< HOST:PORT, the newest first

    bool operator==(ViewerMemory const&) const = default;

    static constexpr std::size_t most_servers = 8;
    /// It is the newest now.
    void note_server(std::string const& address);
};

std::string viewer_memory_text(ViewerMemory const& memory);
/// What is missing or makes no sense is as nothing had been remembered.
ViewerMemory parse_viewer_memory(std::string const& text);

/// framelet/viewer.json where state is kept; what cannot be read is nothing.
ViewerMemory read_viewer_memory();
/// What cannot be written is forgotten: it is not worth a message.
void write_viewer_memory(ViewerMemory const& memory);

} // namespace framelet
