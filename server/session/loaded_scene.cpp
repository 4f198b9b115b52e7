#include "server/session/loaded_scene.h"

#include <cmath>
#include <utility>

#include "server/render/first_look.h"
#include "server/session/welcome.h"

namespace framelet {
namespace {

/// From where on all light is worth half of the samples, which cost a moving picture as much: mean difference in the
/// first view, in steps of 1/255.
constexpr float worth_having = 5;

} // namespace

LoadedScene::LoadedScene(Scene imported, std::vector<Index> playing, std::optional<Environment> environment,
                         LookOptions const& look, Progress const& progress)
    : scene(std::move(imported)), clips(std::move(playing)), render_scene(scene, std::move(environment), progress),
      posed(scene, clips, render_scene), welcome(make_welcome(scene, clips)), light(look.light) {
    bool const by_view = look.light_choice == LightChoice::by_view;
    if (by_view) {
        light.method = LightMethod::reference;
    }
    posed.light_with(light);
    auto const exposure_of = [&](FirstLook const& first) {
        return look.exposure_ev ? std::exp2(*look.exposure_ev) : auto_exposure(first);
    };
    FirstLook const first = take_first_look(render_scene, welcome.start_camera, posed.path_light());
    exposure = exposure_of(first);
    if (by_view) {
        FirstLook const direct = take_first_look(render_scene, welcome.start_camera);
        light_difference = shown_difference(first, direct, {exposure, look.tone_curve});
        bool const shows = *light_difference >= worth_having;
        light.method = shows ? LightMethod::full : LightMethod::direct;
        exposure = shows ? exposure : exposure_of(direct);
        posed.light_with(light);
    }
    render_scene.set_display({exposure, look.tone_curve});
}

} // namespace framelet
