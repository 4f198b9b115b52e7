#include "scenes/things/props.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"

namespace framelet {
namespace {

int bark(GltfDocument& document) {
    return document.add_material({.name = "bark", .base_color = D3(0.13, 0.085, 0.05)});
}

} // namespace

int add_conifer_mesh(GltfDocument& document, std::uint32_t seed) {
    constexpr int tiers = 6;
    constexpr int points = 18;
    MeshData needles;
    for (int tier = 0; tier < tiers; ++tier) {
        double const low = 0.12 + 0.135 * tier;
        double const radius = 0.23 * (1 - 0.8 * tier / (tiers - 1.0)) + 0.015;
        MeshData cone = make_surface(points, 1, [&](double u, double v) {
            int const point = static_cast<int>(std::lround(u * points)) % points;
            double const ragged = (point % 2 == 0 ? 1.0 : 0.72) + 0.16 * (random_unit(seed, tier, point) - 0.5);
            double const angle = 2 * pi * u;
            double const ring = radius * ragged * (1 - v) + 0.002;
            double const height = low + 0.25 * v - 0.035 * (1 - v) * (point % 2 == 0 ? 1 : 0);
            return D3(ring * std::sin(angle), height, ring * std::cos(angle));
        });
        for (std::size_t i = 0; i < cone.normals.size(); ++i) { // a plain cone's: the points are for the outline
            D3 const p = cone.positions[i];
            cone.normals[i] = glm::normalize(D3(p.x, 0, p.z) / (std::hypot(p.x, p.z) + 1e-9) + D3(0, 0.6, 0));
            cone.colors.push_back(D3(p.y > low + 0.1 ? 0.55 : 1.0));
        }
        append(needles, cone);
    }
    needles.uv.clear();
    MeshData trunk = make_cone(0.028, 0.4, 8);
    int const leaf = document.add_material(
        {.name = "needles", .base_color = D3(0.05, 0.11, 0.045), .roughness = 0.9, .double_sided = true});
    return document.add_mesh("conifer", {{std::move(needles), leaf}, {std::move(trunk), bark(document)}});
}

int add_broadleaf_mesh(GltfDocument& document, std::uint32_t seed) {
    MeshData crown;
    for (int blob = 0; blob < 7; ++blob) {
        double const angle = 2 * pi * blob / 6.0;
        double const out = blob == 6 ? 0 : 0.17;
        D3 const center(out * std::cos(angle), 0.62 + (blob == 6 ? 0.16 : 0.1 * random_unit(seed, blob)),
                        out * std::sin(angle));
        double const radius = 0.17 + 0.05 * random_unit(seed, blob, 1);
        MeshData ball = make_surface(16, 9, [&](double u, double v) {
            double const around = 2 * pi * (u >= 1 ? 0 : u);
            double const dents = 1 + 0.16 * value_noise(seed + 7, {u * 8, v * 6 + 9 * blob}, 8);
            double const ring = std::sin(pi * v);
            return center + radius * dents * D3(ring * std::sin(around), -std::cos(pi * v), ring * std::cos(around));
        });
        for (D3 const& p : ball.positions) {
            ball.colors.push_back(D3(std::clamp(0.35 + 1.3 * (p.y - 0.42), 0.2, 1.0)));
        }
        append(crown, ball);
    }
    crown.uv.clear();
    MeshData trunk = make_lathe(std::array<D2, 3>{D2(0.04, 0), D2(0.024, 0.25), D2(0.012, 0.65)}, 8);
    int const leaf = document.add_material(
        {.name = "leaves", .base_color = D3(0.12, 0.21, 0.045), .roughness = 0.9, .double_sided = true});
    return document.add_mesh("broadleaf", {{std::move(crown), leaf}, {std::move(trunk), bark(document)}});
}

int add_house_mesh(GltfDocument& document, int bays, int depth_bays, int floors) {
    constexpr double bay = 3;
    D3 const size(bays * bay, floors * bay, depth_bays * bay);
    MeshData walls = make_box(size, bay);
    walls.indices.resize(walls.indices.size() - 12); // no lid and no floor: the box's last two faces
    MeshData placed;
    append(placed, walls, {{0, size.y / 2, 0}});
    double const rise = 0.32 * size.z;
    MeshData roof;
    double const slope = std::hypot(size.z / 2 + 0.4, rise);
    for (double const side : {1.0, -1.0}) {
        MeshData plane = make_box({size.x + 0.8, 0.14, slope + 0.1}, 1.5);
        double const angle = side * std::atan2(rise, size.z / 2 + 0.4);
        append(roof, plane,
               {{0, size.y + rise / 2 - 0.1, side * (size.z / 4 + 0.2)}, rotation_about({1, 0, 0}, angle)});
    }
    MeshData gables;
    for (double const side : {1.0, -1.0}) {
        auto const first = static_cast<std::uint32_t>(gables.positions.size());
        for (D3 const p :
             {D3(side * size.x / 2, size.y, side * size.z / 2), D3(side * size.x / 2, size.y, -side * size.z / 2),
              D3(side * size.x / 2, size.y + rise - 0.1, 0)}) {
            gables.positions.push_back(p);
            gables.normals.push_back({side, 0, 0});
        }
        gables.indices.insert(gables.indices.end(), {first, first + 1, first + 2});
    }
    int const facade = document.add_material(
        {.name = "facade", .roughness = 0.8, .base_color_texture = document.add_image(facade_texture())});
    int const tiles = document.add_material({.name = "roof tiles",
                                             .base_color = D3(0.42, 0.15, 0.09),
                                             .roughness = 0.8,
                                             .base_color_texture = document.add_image(brick_texture())});
    int const plaster = document.add_material({.name = "plaster", .base_color = D3(0.6, 0.55, 0.45), .roughness = 0.9});
    return document.add_mesh("house",
                             {{std::move(placed), facade}, {std::move(roof), tiles}, {std::move(gables), plaster}});
}

int add_mast_mesh(GltfDocument& document) {
    MeshData wood;
    append(wood, make_lathe(std::array<D2, 3>{D2(0.13, 0), D2(0.09, 8), D2(0, 8)}, 10));
    append(wood, make_box({2.4, 0.12, 0.1}), {{0, 7.3, 0.12}});
    append(wood, make_box({1.6, 0.1, 0.1}), {{0, 6.5, 0.12}});
    MeshData caps;
    for (double const x : {-1.1, -0.4, 0.4, 1.1}) {
        append(caps, make_cylinder(0.05, 0.18, 8), {{x, 7.36, 0.12}});
    }
    int const white = document.add_material({.name = "porcelain", .base_color = D3(0.8), .roughness = 0.15});
    return document.add_mesh("mast", {{std::move(wood), bark(document)}, {std::move(caps), white}});
}

int add_fence_mesh(GltfDocument& document, double length) {
    MeshData fence;
    int const pales = static_cast<int>(length / 0.15);
    for (int pale = 0; pale < pales; ++pale) {
        append(fence, make_box({0.08, 1.15 + 0.05 * random_unit(80, pale), 0.02}),
               {{0.15 * (pale + 0.5) - length / 2, 0.6, 0.03}});
    }
    append(fence, make_box({length, 0.08, 0.04}), {{0, 0.35, 0}});
    append(fence, make_box({length, 0.08, 0.04}), {{0, 0.95, 0}});
    int const white =
        document.add_material({.name = "painted wood", .base_color = D3(0.75, 0.74, 0.70), .roughness = 0.6});
    return document.add_mesh("fence", {{std::move(fence), white}});
}

} // namespace framelet
