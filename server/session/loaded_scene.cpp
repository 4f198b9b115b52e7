#include "server/session/loaded_scene.h"

#include <cmath>
#include <utility>

#include "server/render/framelet_renderer.h"
#include "server/session/welcome.h"

namespace framelet {

LoadedScene::LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                         std::optional<float> exposure_ev, Progress const& progress, LightOptions const& lit_by)
    : scene(std::move(imported)), clips(std::move(playing)), light(lit_by),
      render_scene(scene, std::move(environment), progress), posed(scene, clips, render_scene, light),
      welcome(make_welcome(scene, clips)),
      exposure(exposure_ev ? std::exp2(*exposure_ev)
                           : auto_exposure(render_scene, welcome.start_camera,
                                           posed.light_gathering() != nullptr ? nullptr : posed.path_light())) {}

} // namespace framelet
