#include "server/scene/scene_axes.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/error.h"

namespace framelet {
namespace {

/// Turns of a quarter that take each axis to y, by columns.
std::array<glm::dmat3, 3> const upwards{glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1), glm::dmat3(1),
                                        glm::dmat3(1, 0, 0, 0, 0, -1, 0, 1, 0)};

struct Unit {
    std::string_view word;
    double metres;
};
constexpr std::array<Unit, 6> units{
    {{"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}}};

/// Lets the scene's nodes begin with another, which all that had no parent are below.
void add_root(Scene& scene, Node root) {
    auto const move = [](Index& node) { node += node == none ? 0 : 1; };
    for (Node& node : scene.nodes) {
        ++node.parent; // `none` becomes the root
    }
    scene.nodes.insert(scene.nodes.begin(), std::move(root));
    for (Skin& skin : scene.skins) {
        std::ranges::for_each(skin.joints, move);
    }
    for (AnimationClip& clip : scene.clips) {
        for (AnimationChannel& channel : clip.channels) {
            move(channel.node);
        }
    }
    for (Light& light : scene.lights) {
        move(light.node);
    }
    for (SceneCamera& camera : scene.cameras) {
        move(camera.node);
    }
}

} // namespace

int parse_up_axis(std::string const& word) {
    std::size_t const axis = word.size() == 1 ? std::string_view("xyz").find(word) : std::string_view::npos;
    if (axis == std::string_view::npos) {
        throw InputError("the axis that is up is x, y or z, not '" + word + "'");
    }
    return static_cast<int>(axis);
}

double parse_unit(std::string const& word) {
    auto const* const unit = std::ranges::find(units, word, &Unit::word);
    if (unit == units.end()) {
        throw InputError("a unit is mm, cm, m, km, in or ft, not '" + word + "'");
    }
    return unit->metres;
}

void orient_scene(Scene& scene, int up_axis, double unit_metres) {
    static_assert(none == -1, "add_root counts on it");
    if (up_axis == 1 && unit_metres == 1) {
        return;
    }
    auto const scale = static_cast<float>(unit_metres);
    Node root;
    root.matrix = glm::dmat4(unit_metres * upwards[static_cast<std::size_t>(up_axis)]);
    (*root.matrix)[3][3] = 1;
    add_root(scene, std::move(root));
    for (Light& light : scene.lights) {
        light.range *= scale;
        light.intensity *= light.type == LightType::directional ? 1 : scale * scale; // as distances shrink
    }
    for (SceneCamera& camera : scene.cameras) {
        camera.vertical_extent *= camera.projection == Projection::orthographic ? scale : 1;
    }
}

} // namespace framelet
