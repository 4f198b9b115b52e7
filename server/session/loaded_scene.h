// A scene as it is loaded, with what is made of it for rendering. A resource that stays where it is: its parts point to
// each other.
#pragma once

#include <optional>
#include <vector>

#include "server/render/prepared/render_scene.h"
#include "server/scene/scene.h"
#include "server/scene/scene_import.h"

namespace framelet {

struct LoadedScene {
    /// Without `exposure_ev` (stops) the exposure is chosen for what the first camera sees.
    LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                std::optional<float> exposure_ev, Progress const& progress);
    LoadedScene(LoadedScene const&) = delete;
    LoadedScene& operator=(LoadedScene const&) = delete;

    Scene const scene;
    std::vector<Index> const clips; ///< that play
    RenderScene render_scene;
    float exposure = 1;
};

} // namespace framelet
