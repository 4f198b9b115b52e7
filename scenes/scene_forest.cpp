#include <array>
#include <cmath>

#include "scenes/gltf/animations.h"
#include "scenes/large_scenes.h"
#include "scenes/things/landscape.h"
#include "scenes/things/trees.h"

namespace framelet {

GltfDocument make_forest_scene(ForestParameters const& parameters) {
    GltfDocument document;
    document.light = "";
    add_sun(document, {-0.35, 0.80, 0.45});
    add_surroundings(document);
    int const side = static_cast<int>(std::ceil(std::sqrt(parameters.trees)));
    double const width = side * parameters.spacing;
    add_meadow(document, 1.1 * width);
    auto const [leaves, bark] = add_plant_materials(document);
    std::array<int, 8> trees{};
    for (std::uint32_t kind = 0; kind < trees.size(); ++kind) {
        trees[kind] =
            document.add_mesh("tree", {{make_crown(310 + kind, parameters.twigs), leaves}, {make_trunk(), bark}});
    }
    for (int i = 0; i < parameters.trees; ++i) {
        auto const random = [i](int what) { return random_unit(340, i, what); };
        D3 const foot(parameters.spacing * (i % side + random(0)) - 0.5 * width, 0,
                      parameters.spacing * (i / side + random(1)) - 0.5 * width);
        document.add_node({.name = "tree",
                           .place = {foot, rotation_about({0, 1, 0}, 2 * pi * random(2)), D3(0.8 + 0.7 * random(3))},
                           .mesh = trees[static_cast<std::size_t>(trees.size() * random(4))]});
    }
    int const camera = add_camera(document, {0, 0, 0}, {0, 0, -1}, 50);
    auto const position = [&](double time) {
        double const angle = 2 * pi * time / parameters.duration;
        return D3(0.1 * width * std::sin(angle), 14 + 4 * std::sin(2 * angle), 0.1 * width * std::cos(angle));
    };
    document.tracks.push_back(translation_track(camera, parameters.duration, 240, position));
    document.tracks.push_back(rotation_track(camera, parameters.duration, 240, [&](double time) {
        return looking_at(position(time), position(time + 0.09 * parameters.duration) - D3(0, 5, 0));
    }));
    return document;
}

} // namespace framelet
