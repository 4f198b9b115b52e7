#include "scenes/things/trees.h"

#include <array>
#include <cmath>

#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"

namespace framelet {

PlantMaterials add_plant_materials(GltfDocument& document) {
    int const leaves = document.add_material({.name = "twigs",
                                              .roughness = 0.8,
                                              .base_color_texture = document.add_image(leaf_texture()),
                                              .alpha_cutoff = 0.5,
                                              .double_sided = true});
    return {leaves, document.add_material({.name = "bark", .base_color = D3(0.20, 0.15, 0.10)})};
}

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

} // namespace framelet
