// A scene as it is loaded, with all that is made of it to serve it: a server that has viewers only changes over. A
// resource that stays where it is: its parts point to each other.
#pragma once

#include <optional>
#include <vector>

#include "protocol/messages/message.h"
#include "server/render/prepared/render_scene.h"
#include "server/scene/scene.h"
#include "server/scene/scene_import.h"
#include "server/stream/posed_scene.h"

namespace framelet {

struct LoadedScene {
    /// Without `exposure_ev` (stops) the exposure is chosen for what the first camera sees.
    LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                std::optional<float> exposure_ev, Progress const& progress, LightOptions const& lit_by = {});

    Scene const scene;
    std::vector<Index> const clips; ///< that play
    LightOptions const light;
    RenderScene render_scene;
    PosedScene posed;
    Welcome welcome; ///< as `make_welcome`
    float exposure = 1;
};

} // namespace framelet
