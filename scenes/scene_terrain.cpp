#include <algorithm>
#include <cmath>

#include "scenes/failure_scenes.h"
#include "scenes/gltf/animations.h"
#include "scenes/things/landscape.h"

namespace framelet {
namespace {

/// Ridged noise: mountains in the large, scree in the small.
double mountain_height(D2 at) {
    double const large = 1 - std::abs(fractal_noise(200, at / 60.0, 3));
    double const middle = fractal_noise(210, at / 14.0, 3);
    double const small = fractal_noise(220, at / 1.6, 3, 0, 0.7);
    return 26 * large * large - 14 + 3.0 * middle + 0.55 * small;
}

/// The mountains sink below the plain towards the edge.
double terrain_height(D2 at, double half_side) {
    double const inside = std::clamp(6 * (1 - std::max(std::abs(at.x), std::abs(at.y)) / half_side), 0.0, 1.0);
    return glm::mix(-22.0, mountain_height(at), inside * inside * (3 - 2 * inside));
}

MeshData make_terrain(TerrainParameters const& parameters) {
    MeshData mesh;
    D2 const corner = -0.5 * parameters.cell * D2(parameters.columns, parameters.rows);
    double const half_side = -std::max(corner.x, corner.y);
    auto const height_at = [half_side](D2 at) { return terrain_height(at, half_side); };
    auto const width = static_cast<std::uint32_t>(parameters.columns + 1);
    for (int j = 0; j <= parameters.rows; ++j) {
        for (int i = 0; i <= parameters.columns; ++i) {
            D2 const at = corner + parameters.cell * D2(i, j);
            double const height = height_at(at);
            double const step = 0.35 * parameters.cell; // finer than the cells: neighbours differ
            D3 const normal =
                glm::normalize(D3(height - height_at(at + D2(step, 0)), step, height - height_at(at + D2(0, step))));
            double const rock = std::clamp((0.88 - normal.y) * 5, 0.0, 1.0);
            double const snow = std::clamp((height - 7) * 0.5 + 2 * (normal.y - 0.7), 0.0, 1.0) * (1 - 0.6 * rock);
            double const speck = 0.6 + 0.7 * random_unit(230, i, j);
            D3 const ground = glm::mix(D3(0.20, 0.26, 0.09), D3(0.34, 0.30, 0.25), rock) * speck;
            mesh.positions.push_back({at.x, height, at.y});
            mesh.normals.push_back(normal);
            mesh.colors.push_back(glm::mix(ground, D3(0.72, 0.74, 0.78), snow));
            if (i < parameters.columns && j < parameters.rows) {
                std::uint32_t const a = static_cast<std::uint32_t>(j) * width + static_cast<std::uint32_t>(i);
                mesh.indices.insert(mesh.indices.end(), {a, a + width, a + width + 1, a, a + width + 1, a + 1});
            }
        }
    }
    return mesh;
}

} // namespace

GltfDocument make_terrain_scene(TerrainParameters const& parameters) {
    GltfDocument document;
    add_sun(document, {-0.55, 0.80, 0.25});
    add_surroundings(document);
    int const ground = document.add_material({.name = "ground", .roughness = 0.55});
    document.add_object("terrain", make_terrain(parameters), ground, {{0, 18, 0}});
    int const camera = add_camera(document, {0, 0, 0}, {0, 0, -1}, 50);
    auto const position = [&](double time) {
        double const angle = 2 * pi * time / parameters.duration;
        return D3(parameters.flight_radius * std::sin(angle), parameters.flight_height + 4 * std::sin(2 * angle),
                  parameters.flight_radius * std::cos(angle));
    };
    document.tracks.push_back(translation_track(camera, parameters.duration, 240, position));
    document.tracks.push_back(rotation_track(camera, parameters.duration, 240, [&](double time) {
        D3 const ahead = position(time + 0.09 * parameters.duration);
        return looking_at(position(time), D3(ahead.x * 0.45, 22, ahead.z * 0.45));
    }));
    return document;
}

} // namespace framelet
