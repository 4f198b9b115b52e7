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

/// How a scene is to look.
struct LookOptions {
    std::optional<float> exposure_ev{}; ///< stops; nothing: chosen for what the first camera sees
    ToneCurve tone_curve = ToneCurve::neutral;
    LightOptions light{};
    LightChoice light_choice = LightChoice::told; ///< of the method of `light`
};

struct LoadedScene {
    LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                LookOptions const& look, Progress const& progress);

    Scene const scene;
    std::vector<Index> const clips; ///< that play
    RenderScene render_scene;
    PosedScene posed;
    Welcome welcome; ///< as `make_welcome`
    LightOptions light;
    /// How far direct light is from all light in the first view, where the light was chosen by that; steps of 1/255.
    std::optional<float> light_difference;
    float exposure = 1;
};

} // namespace framelet
