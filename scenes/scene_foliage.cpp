#include <array>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/landscape.h"

namespace framelet {
namespace {

/// Twigs on shells about (0, 4, 0), 4 m across; lit as the crown is, not each by its own plane.
MeshData make_crown(std::uint32_t seed, int twigs) {
    MeshData crown;
    for (int twig = 0; twig < twigs; ++twig) {
        auto const random = [&](int what) { return random_unit(seed, twig, what); };
        double const up = 2 * random(0) - 1;
        double const around = 2 * pi * random(1);
        double const flat = std::sqrt(1 - up * up);
        D3 const outward(flat * std::cos(around), up, flat * std::sin(around));
        double const shell = 0.55 + 0.45 * std::sqrt(random(2));
        D3 const place = D3(0, 4, 0) + shell * D3(2.0, 1.7, 2.0) * outward;
        DQuat const turned = looking_at(outward, {0, 0, 0}) * rotation_about({1, 0, 0}, 2.2 * (random(3) - 0.5)) *
                             rotation_about({0, 0, 1}, 2 * pi * random(4));
        double const size = 0.36 + 0.28 * random(5);
        MeshData placed;
        append(placed, make_card({size, size}), {place, turned, {1, 1, 1}});
        placed.normals.assign(placed.positions.size(), glm::normalize(outward + D3(0, 0.35, 0)));
        paint(placed, D3(shell * (0.65 + 0.35 * random(6))));
        append(crown, placed);
    }
    return crown;
}

MeshData make_trunk() {
    std::array<D2, 4> const profile{D2(0.26, 0), D2(0.16, 0.7), D2(0.11, 2.6), D2(0.03, 5)};
    MeshData trunk = make_lathe(profile, 12);
    for (int branch = 0; branch < 6; ++branch) {
        DQuat const turned = rotation_about({0, 1, 0}, branch * 1.05) * rotation_about({0, 0, 1}, 0.9);
        append(trunk, make_cone(0.07, 1.8, 8), {{0, 2.3 + 0.2 * branch, 0}, turned, {1, 1, 1}});
    }
    trunk.uv.clear();
    return trunk;
}

/// Ferns: a few cards from one root.
MeshData make_fern() {
    MeshData fern;
    for (int leaf = 0; leaf < 6; ++leaf) {
        DQuat const turned = rotation_about({0, 1, 0}, leaf * 1.05 + 0.2) * rotation_about({1, 0, 0}, -0.8);
        DQuat const upright = turned * rotation_about({0, 0, 1}, pi / 2); // the twig's root is at the card's left edge
        append(fern, make_card({0.7, 0.7}), {turned * D3(0.35, 0.35, 0), upright, {1, 1, 1}});
    }
    fern.normals.assign(fern.positions.size(), D3(0, 1, 0));
    paint(fern, D3(0.8));
    return fern;
}

} // namespace

GltfDocument make_foliage_scene(FoliageParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.35, 0.80, 0.45});
    add_surroundings(document);
    add_meadow(document, 160);
    int const leaves = document.add_material({.name = "twigs",
                                              .roughness = 0.8,
                                              .base_color_texture = document.add_image(leaf_texture()),
                                              .alpha_cutoff = 0.5,
                                              .double_sided = true});
    int const bark = document.add_material({.name = "bark", .base_color = D3(0.20, 0.15, 0.10)});
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
