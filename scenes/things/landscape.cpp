#include "scenes/things/landscape.h"

#include <algorithm>
#include <cmath>

#include "scenes/gltf/animations.h"
#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"
#include "scenes/things/props.h"

namespace framelet {
namespace {

constexpr double road_half_width = 4;
constexpr double road_height = 0.02;
constexpr double field_half_width = 160;
constexpr double hills_radius = 900;
constexpr double sky_radius = 1500;

/// A level grid centred on the origin, facing +Y, with a colour a vertex and one texture repeat a `texture_size`.
MeshData make_tinted_grid(D2 size, int columns, int rows, double texture_size, double (*tint)(D2)) {
    MeshData grid = make_surface(
        columns, rows, [&](double u, double v) { return D3((u - 0.5) * size.x, 0, (0.5 - v) * size.y); },
        size / texture_size);
    for (D3 const& p : grid.positions) {
        grid.colors.push_back(D3(tint({p.x, p.z})));
    }
    return grid;
}

/// Factor of the fields' colour: coarse light and dark; repeats along Z.
double field_tint(D2 at) {
    return std::clamp(0.74 + 0.30 * fractal_noise(100, {at.x / 20, at.y / roadside_period * 6}, 3, 6), 0.3, 1.0);
}

/// Factor of the road's colour: worn tracks where the wheels run, stains along them.
double road_tint(D2 at) {
    double const lane = std::abs(std::abs(at.x) - 2);
    double const track = std::abs(lane - 0.8) < 0.3 ? -0.12 : 0.0;
    return std::clamp(0.82 + track + 0.2 * fractal_noise(101, {at.x / 2, at.y / roadside_period * 40}, 2, 40), 0.3,
                      1.0);
}

void add_markings(MeshData& lines, MeshData& patches) {
    auto const add_strip = [](MeshData& mesh, D2 size, double x, double z, double height) {
        append(mesh, make_ground(size, 2), {{x, height, z}});
    };
    for (double const x : {-road_half_width + 0.25, road_half_width - 0.25}) {
        add_strip(lines, {0.12, roadside_period}, x, 0, road_height + 0.004);
    }
    for (int dash = 0; dash < 10; ++dash) {
        add_strip(lines, {0.12, 4}, 0, 12 * dash - 54, road_height + 0.004);
    }
    for (int patch = 0; patch < 14; ++patch) { // mended places
        auto const random = [patch](int what) { return random_unit(102, patch, what); };
        D2 const size(0.4 + 1.2 * random(0), 0.5 + 3 * random(1));
        add_strip(patches, size, 6 * (random(2) - 0.5), (roadside_period - 4) * (random(3) - 0.5), road_height + 0.002);
    }
}

MeshData make_guard_rail() {
    MeshData rail;
    append(rail, make_rounded_box({0.06, 0.26, roadside_period}, 0.028), {{road_half_width + 1.2, 0.62, 0}});
    for (int post = 0; post < 30; ++post) {
        append(rail, make_box({0.08, 0.6, 0.1}), {{road_half_width + 1.28, 0.3, 4.0 * post - 58}});
    }
    rail.uv.clear();
    return rail;
}

/// White posts with a black band: small, high contrast, every 12 m.
void add_marker_posts(MeshData& white, MeshData& black) {
    for (int post = 0; post < 10; ++post) {
        D3 const foot(-road_half_width - 1.1, 0, 12.0 * post - 54);
        append(white, make_rounded_box({0.12, 0.95, 0.12}, 0.02), {foot + D3(0, 0.475, 0)});
        append(black, make_box({0.126, 0.18, 0.126}), {foot + D3(0, 0.72, 0)});
    }
    white.uv.clear();
    black.uv.clear();
}

struct Scenery {
    std::vector<int> trees;
    int small_house, large_house, mast;
};

/// Adds what stands along one stretch; it is the same for every stretch.
void add_scenery(GltfDocument& document, Scenery const& scenery, int stretch) {
    for (int i = 0; i < 26; ++i) {
        auto const random = [i](int what) { return random_unit(103, i, what); };
        double const side = random(0) < 0.6 ? -1 : 1;
        double const x = side * (10 + 60 * random(1) * random(1));
        double const z = roadside_period * ((i + random(2)) / 26 - 0.5);
        double const height = 4.5 + 5 * random(3);
        if (x > 12 && x < 34 && std::abs(z) < 42) {
            continue; // the houses stand there
        }
        document.add_node({.name = "tree",
                           .place = {{x, 0, z}, rotation_about({0, 1, 0}, 2 * pi * random(4)), D3(height)},
                           .mesh = scenery.trees[static_cast<std::size_t>(random(5) * 4)]},
                          stretch);
    }
    DQuat const facing_road = rotation_about({0, 1, 0}, -pi / 2);
    document.add_node({.name = "house", .place = {{20, 0, -26}, facing_road}, .mesh = scenery.large_house}, stretch);
    document.add_node({.name = "house", .place = {{17, 0, 4}, facing_road}, .mesh = scenery.small_house}, stretch);
    document.add_node({.name = "house", .place = {{22, 0, 30}, facing_road}, .mesh = scenery.small_house}, stretch);
    for (double const z : {-40.0, 0.0, 40.0}) {
        document.add_node({.name = "mast", .place = {{-8.5, 0, z}}, .mesh = scenery.mast}, stretch);
    }
}

/// Ridges around the origin, seen from inside the ring.
MeshData make_hills() {
    MeshData hills = make_surface(240, 6, [](double u, double v) {
        double const angle = 2 * pi * (u >= 1 ? 0 : -u);
        double const ridge = 0.5 + 0.5 * fractal_noise(105, {u * 12, 0.5}, 5, 12, 0.55);
        double const height = hills_radius * (0.015 + 0.10 * ridge * ridge);
        double const dents = 1 + 0.24 * v * (1 - v) * value_noise(106, {u * 60, v * 3}, 60);
        double const distance = hills_radius * (1.0 + 0.45 * v) * dents;
        return D3(distance * std::sin(angle), height * std::sin(pi / 2 * v) - 1 + v, distance * std::cos(angle));
    });
    for (D3 const& p : hills.positions) {
        double const patchy = fractal_noise(107, {p.x / 80, p.z / 80}, 3);
        hills.colors.push_back(D3(0.17, 0.23, 0.13) * (0.8 + 0.4 * patchy) + D3(0.02, 0.035, 0.07));
    }
    hills.uv.clear();
    return hills;
}

/// The inside of a band of a sphere, from under the horizon to 50 degrees; the texture twice around.
MeshData make_sky() {
    return make_surface(48, 8,
                        [](double u, double v) {
                            double const angle = -2 * pi * (u >= 1 ? 0 : u);
                            double const elevation = radians(-2 + 52 * v);
                            return sky_radius * D3(std::cos(elevation) * std::sin(angle), std::sin(elevation),
                                                   std::cos(elevation) * std::cos(angle));
                        },
                        {2, -1});
}

int add_grass(GltfDocument& document) {
    return document.add_material({.name = "grass",
                                  .base_color = D3(0.62, 0.72, 0.28),
                                  .base_color_texture = document.add_image(grass_texture())});
}

} // namespace

void add_meadow(GltfDocument& document, double side) {
    document.add_object("meadow", make_tinted_grid(D2(side), 20, 20, 3, field_tint), add_grass(document));
}

void add_roadside(GltfDocument& document, int first, int last) {
    int const grass = add_grass(document);
    int const asphalt_image = document.add_image(asphalt_texture());
    int const asphalt = document.add_material({.name = "asphalt",
                                               .base_color = D3(0.42, 0.42, 0.44),
                                               .roughness = 0.85,
                                               .base_color_texture = asphalt_image});
    int const line = document.add_material(
        {.name = "road line", .base_color = D3(1.0), .roughness = 0.7, .base_color_texture = asphalt_image});
    int const tar = document.add_material(
        {.name = "tar", .base_color = D3(0.14), .roughness = 0.5, .base_color_texture = asphalt_image});
    int const steel =
        document.add_material({.name = "steel", .base_color = D3(0.6), .metallic = 0.9, .roughness = 0.3});
    int const white = document.add_material({.name = "white post", .base_color = D3(0.85), .roughness = 0.4});
    int const black = document.add_material({.name = "black band", .base_color = D3(0.02), .roughness = 0.4});

    MeshData lines;
    MeshData patches;
    add_markings(lines, patches);
    MeshData road;
    append(road, make_tinted_grid({2 * road_half_width, roadside_period}, 40, 60, 2, road_tint), {{0, road_height, 0}});
    MeshData posts;
    MeshData bands;
    add_marker_posts(posts, bands);
    int const surface = document.add_mesh(
        "road and fields", {{make_tinted_grid({2 * field_half_width, roadside_period}, 40, 20, 3, field_tint), grass},
                            {std::move(road), asphalt},
                            {std::move(lines), line},
                            {std::move(patches), tar},
                            {make_guard_rail(), steel},
                            {std::move(posts), white},
                            {std::move(bands), black}});
    Scenery const scenery{{add_conifer_mesh(document, 1), add_conifer_mesh(document, 2),
                           add_broadleaf_mesh(document, 3), add_broadleaf_mesh(document, 4)},
                          add_house_mesh(document, 3, 2, 2),
                          add_house_mesh(document, 6, 3, 3),
                          add_mast_mesh(document)};
    for (int stretch = first; stretch <= last; ++stretch) {
        int const node =
            document.add_node({.name = "stretch", .place = {{0, 0, roadside_period * stretch}}, .mesh = surface});
        add_scenery(document, scenery, node);
    }
}

void add_yard(GltfDocument& document, D3 center, D2 size) {
    MeshData slabs;
    append(slabs,
           make_tinted_grid(size, 16, 16, 4, [](D2 at) { return 0.85 + 0.15 * fractal_noise(104, at / 3.0, 2); }));
    int const slab = document.add_material({.name = "slabs",
                                            .base_color = D3(0.8, 0.76, 0.70),
                                            .roughness = 0.7,
                                            .base_color_texture = document.add_image(slab_texture())});
    int const mesh = document.add_mesh("yard", {{std::move(slabs), slab}});
    document.add_node({.name = "yard", .place = {center}, .mesh = mesh});
}

int add_surroundings(GltfDocument& document) {
    int const forest = document.add_material({.name = "forest", .roughness = 1, .double_sided = true});
    int const far_fields = document.add_material({.name = "far fields", .base_color = D3(0.17, 0.21, 0.075)});
    int const sky =
        document.add_material({.name = "sky", .base_color_texture = document.add_image(sky_texture()), .unlit = true});
    MeshData plain = make_ground({2.1 * hills_radius, 2.1 * hills_radius}, 1);
    plain.uv.clear();
    int const mesh =
        document.add_mesh("surroundings", {{make_hills(), forest}, {std::move(plain), far_fields}, {make_sky(), sky}});
    return document.add_node({.name = "surroundings", .place = {{0, -0.3, 0}}, .mesh = mesh});
}

void add_sun(GltfDocument& document, D3 towards_sun) {
    document.lights.push_back({"directional", {1.0, 0.96, 0.88}, pi}); // lux
    document.add_node({.name = "sun",
                       .place = {.rotation = looking_at(towards_sun, {0, 0, 0})},
                       .light = static_cast<int>(document.lights.size()) - 1});
}

int add_camera(GltfDocument& document, D3 eye, D3 target, double vertical_fov_degrees, int parent) {
    document.cameras.push_back({"camera", radians(vertical_fov_degrees)});
    return document.add_node({.name = "camera",
                              .place = {.translation = eye, .rotation = looking_at(eye, target)},
                              .camera = static_cast<int>(document.cameras.size()) - 1},
                             parent);
}

void add_drifting_camera(GltfDocument& document, D3 eye, D3 target, double vertical_fov_degrees, double drift,
                         double duration) {
    int const camera = add_camera(document, eye, target, vertical_fov_degrees);
    D3 const aside = looking_at(eye, target) * D3(1, 0, 0);
    document.tracks.push_back(translation_track(
        camera, duration, 48, [&](double time) { return eye + drift * std::sin(2 * pi * time / duration) * aside; }));
}

} // namespace framelet
