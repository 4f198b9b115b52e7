// What the window remembers of a scene beside its bookmarks. In and out: a file for each scene.
#pragma once

#include <cstdint>
#include <string>

namespace framelet {

/// Greatest exposure that a viewer may ask for, either way; stops.
inline constexpr float largest_exposure = 16;

struct SceneMemory {
    float exposure_ev = 0;

    bool operator==(SceneMemory const&) const = default;
};

/// Reads framelet/scenes/SCENE-PLACE.json where state is kept; a file that cannot be read, or makes no sense, is as
/// none. `scene_source` as in Welcome.
SceneMemory read_scene_memory(std::string const& scene_name, std::uint64_t scene_source);
/// Writes that file. What cannot be written is forgotten: it is not worth a message.
void write_scene_memory(std::string const& scene_name, std::uint64_t scene_source, SceneMemory const& memory);

} // namespace framelet
