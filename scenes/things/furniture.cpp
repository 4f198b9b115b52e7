#include "scenes/things/furniture.h"

#include <array>
#include <cmath>

#include "scenes/mesh/mesh_builder.h"
#include "scenes/mesh/textures.h"

namespace framelet {

RoomMaterials add_room_materials(GltfDocument& document) {
    auto const textured = [&](char const* name, D3 color, double roughness, std::string image) {
        return document.add_material({.name = name,
                                      .base_color = color,
                                      .roughness = roughness,
                                      .base_color_texture = document.add_image(std::move(image))});
    };
    auto const plain = [&](char const* name, D3 color, double roughness) {
        return document.add_material({.name = name, .base_color = color, .roughness = roughness});
    };
    RoomMaterials materials{};
    materials.boards = textured("boards", D3(0.72, 0.50, 0.30), 0.35, plank_texture());
    materials.bricks = textured("painted bricks", D3(0.95, 0.92, 0.84), 0.8, brick_texture());
    materials.plaster = plain("plaster", D3(0.62, 0.66, 0.60), 0.9);
    materials.rug = textured("rug", D3(0.75, 0.30, 0.24), 0.95, checker_texture());
    materials.map = textured("map", D3(1), 0.5, globe_texture());
    materials.wood = textured("wood", D3(0.50, 0.29, 0.15), 0.5, plank_texture());
    materials.cloth = textured("cloth", D3(0.95), 0.95, stripe_texture());
    materials.china = plain("china", D3(0.80, 0.80, 0.76), 0.1);
    materials.paint = plain("green paint", D3(0.07, 0.24, 0.19), 0.5);
    materials.brass =
        document.add_material({.name = "brass", .base_color = D3(0.85, 0.63, 0.28), .metallic = 1, .roughness = 0.25});
    materials.glow = document.add_material({.name = "glow", .base_color = D3(0.8), .emissive = D3(9, 8.2, 6.6)});
    return materials;
}

void add_table(GltfDocument& document, RoomMaterials const& materials, D3 place) {
    MeshData table;
    append(table, make_box({1.5, 0.05, 0.9}, 0.6), {{0, 0.735, 0}});
    for (double const x : {-0.68, 0.68}) {
        for (double const z : {-0.38, 0.38}) {
            append(table, make_box({0.07, 0.71, 0.07}, 0.6), {{x, 0.355, z}});
        }
    }
    document.add_object("table", std::move(table), materials.wood, {place});
    std::array<D2, 7> const vase{D2(0.05, 0),     D2(0.085, 0.07), D2(0.085, 0.14), D2(0.04, 0.23),
                                 D2(0.035, 0.27), D2(0.05, 0.30),  D2(0.04, 0.30)};
    std::array<D2, 6> const bowl{D2(0.05, 0),    D2(0.10, 0.02), D2(0.16, 0.08),
                                 D2(0.15, 0.08), D2(0.09, 0.03), D2(0, 0.02)};
    std::array<D2, 5> const cup{D2(0.03, 0), D2(0.042, 0.02), D2(0.042, 0.09), D2(0.037, 0.09), D2(0.03, 0.01)};
    D3 const top = place + D3(0, 0.76, 0);
    document.add_object("vase", make_lathe(vase, 28), materials.paint, {top + D3(-0.5, 0, -0.2)});
    document.add_object("bowl", make_lathe(bowl, 32), materials.china, {top + D3(0.1, 0, -0.05)});
    for (double const x : {-0.25, 0.5}) {
        document.add_object("cup", make_lathe(cup, 20), materials.china, {top + D3(x, 0, 0.25)});
    }
    int const orange = document.add_material({.name = "orange", .base_color = D3(0.85, 0.33, 0.04), .roughness = 0.5});
    for (int i = 0; i < 4; ++i) {
        D3 const at = i == 3 ? D3(0, 0.12, 0) : D3(0.055 * std::cos(2.1 * i), 0.065, 0.055 * std::sin(2.1 * i));
        document.add_object("orange", make_sphere(0.042, 16), orange, {top + D3(0.1, 0, -0.05) + at});
    }
}

int add_chair_mesh(GltfDocument& document, RoomMaterials const& materials) {
    MeshData wood;
    MeshData seat = make_box({0.44, 0.05, 0.42}, 0.3);
    for (double const x : {-0.19, 0.19}) {
        append(wood, make_box({0.04, 0.45, 0.04}, 0.5), {{x, 0.225, 0.18}});
        append(wood, make_box({0.04, 0.95, 0.04}, 0.5), {{x, 0.475, -0.19}});
    }
    for (double const y : {0.62, 0.74, 0.88}) {
        append(wood, make_box({0.40, 0.07, 0.02}, 0.5), {{0, y, -0.19}});
    }
    MeshData cushion;
    append(cushion, seat, {{0, 0.46, 0}});
    return document.add_mesh("chair", {{std::move(wood), materials.wood}, {std::move(cushion), materials.cloth}});
}

void add_book_shelf(GltfDocument& document, RoomMaterials const& materials, D3 place) {
    MeshData boards;
    MeshData books;
    for (int board = 0; board < 5; ++board) {
        double const y = 0.1 + 0.4 * board;
        append(boards, make_box({1.3, 0.03, 0.28}, 0.6), {{0, y, 0}});
        double x = -0.6;
        for (int book = 0; board < 4 && x < 0.5; ++book) {
            auto const random = [&](int what) { return random_unit(400, board, book, what); };
            D3 const size(0.025 + 0.035 * random(0), 0.2 + 0.12 * random(1), 0.18 + 0.05 * random(2));
            MeshData volume = make_box(size);
            paint(volume, D3(0.15 + 0.7 * random(3), 0.12 + 0.5 * random(4), 0.10 + 0.4 * random(5)));
            append(books, volume, {{x + size.x / 2, y + 0.015 + size.y / 2, 0.02}});
            x += size.x + (random(6) < 0.12 ? 0.16 : 0.003);
        }
    }
    for (double const x : {-0.665, 0.665}) {
        append(boards, make_box({0.03, 1.75, 0.28}, 0.6), {{x, 0.875, 0}});
    }
    int const covers = document.add_material({.name = "book covers", .roughness = 0.6});
    books.uv.clear();
    document.add_object("shelf", std::move(boards), materials.wood, {place});
    document.add_object("books", std::move(books), covers, {place});
}

void add_sofa(GltfDocument& document, RoomMaterials const& materials, Placement const& place) {
    MeshData frame;
    MeshData cushions;
    append(frame, make_rounded_box({1.9, 0.3, 0.85}, 0.06), {{0, 0.2, 0}});
    append(frame, make_rounded_box({1.9, 0.55, 0.2}, 0.08), {{0, 0.6, -0.34}});
    for (double const side : {-1.0, 1.0}) {
        append(frame, make_rounded_box({0.2, 0.5, 0.85}, 0.08), {{side * 0.88, 0.38, 0}});
        append(cushions, make_rounded_box({0.76, 0.16, 0.62}, 0.06), {{side * 0.39, 0.42, 0.08}});
    }
    frame.uv.clear();
    document.add_node({.name = "sofa",
                       .place = place,
                       .mesh = document.add_mesh(
                           "sofa", {{std::move(frame), materials.paint}, {std::move(cushions), materials.cloth}})});
}

void add_framed_map(GltfDocument& document, RoomMaterials const& materials, D3 place) {
    document.add_object("map", make_card({1.5, 0.75}), materials.map, {place + D3(0, 0, 0.01)});
    MeshData frame;
    for (double const side : {-1.0, 1.0}) {
        append(frame, make_box({0.05, 0.85, 0.04}, 0.5), {{side * 0.775, 0.375, 0}});
        append(frame, make_box({1.5, 0.05, 0.04}, 0.5), {{0, 0.375 + side * 0.4, 0}});
    }
    document.add_object("frame", std::move(frame), materials.wood, {place});
}

void add_lamp(GltfDocument& document, RoomMaterials const& materials, D3 place, D3 color, double candela) {
    document.lights.push_back({"point", color, candela});
    document.add_node({.name = "light", .place = {place}, .light = static_cast<int>(document.lights.size()) - 1});
    document.add_object("bulb", make_sphere(0.05, 16), materials.glow, {place + D3(0, 0.07, 0)});
    document.add_object("socket", make_cylinder(0.035, 0.06, 16), materials.brass, {place + D3(0, 0.11, 0)});
}

} // namespace framelet
