#include <array>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/things/landscape.h"
#include "scenes/things/trees.h"

namespace framelet {
GltfDocument make_foliage_scene(FoliageParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.35, 0.80, 0.45});
    add_surroundings(document);
    add_meadow(document, 160);
    auto const [leaves, bark] = add_plant_materials(document);
    int const trunk = document.add_mesh("trunk", {{make_trunk(), bark}});
    std::array<int, 3> crowns{};
    for (std::uint32_t kind = 0; kind < crowns.size(); ++kind) {
        crowns[kind] = document.add_mesh("crown", {{make_crown(310 + kind, parameters.twigs), leaves}});
    }
    int const fern = document.add_mesh("fern", {{make_fern(), leaves}});
    for (int i = 0; i < parameters.trees; ++i) {
        auto const random = [i](int what) { return random_unit(320, i, what); };
        double const depth = 3 + 62 * i / (parameters.trees - 1.0);
        D3 const foot((random(0) - 0.5) * (9 + 1.3 * depth), 0, -depth);
        if (std::abs(foot.x) < 1.6 && depth < 12) {
            continue; // the view down the wood
        }
        DQuat const turned = rotation_about({0, 1, 0}, 2 * pi * random(1));
        int const tree =
            document.add_node({.name = "tree", .place = {foot, turned, D3(0.9 + 0.5 * random(2))}, .mesh = trunk});
        int const crown =
            document.add_node({.name = "crown", .mesh = crowns[static_cast<std::size_t>(3 * random(3))]}, tree);
        double const phase = 2 * pi * random(4);
        int const cycles = 2 + static_cast<int>(3 * random(5));
        document.tracks.push_back(rotation_track(crown, parameters.duration, 16 * cycles, [&](double time) {
            double const swing = radians(parameters.sway_degrees);
            double const angle = 2 * pi * cycles * time / parameters.duration + phase;
            return rotation_about({1, 0, 0}, swing * std::sin(angle)) *
                   rotation_about({0, 0, 1}, 0.6 * swing * std::cos(angle));
        }));
    }
    for (int i = 0; i < 90; ++i) {
        double const depth = 1.5 + 25 * random_unit(330, i) * random_unit(331, i);
        D3 const foot((random_unit(332, i) - 0.5) * (5 + 1.2 * depth), 0, 3 - depth);
        document.add_node(
            {.name = "fern",
             .place = {foot, rotation_about({0, 1, 0}, 6 * random_unit(333, i)), D3(0.5 + 0.5 * random_unit(334, i))},
             .mesh = fern});
    }
    int const camera = add_camera(document, {0, 1.7, 6}, {0, 2.6, -6}, 50);
    document.tracks.push_back(translation_track(camera, parameters.duration, 64, [&](double time) {
        return D3(parameters.drift * std::sin(2 * pi * time / parameters.duration), 1.7, 6);
    }));
    return document;
}

} // namespace framelet
