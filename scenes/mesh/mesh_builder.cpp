#include "scenes/mesh/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace framelet {
namespace {

void add_quad(MeshData& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    auto const add_triangle = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        D3 const ij = mesh.positions[j] - mesh.positions[i];
        D3 const ik = mesh.positions[k] - mesh.positions[i];
        if (glm::length(glm::cross(ij, ik)) > 1e-10) {
            mesh.indices.insert(mesh.indices.end(), {i, j, k});
        }
    };
    add_triangle(a, b, c);
    add_triangle(a, c, d);
}

/// A flat face: corner, and the two edges whose cross product is the outward normal.
void add_face(MeshData& mesh, D3 corner, D3 along, D3 across, D2 repeats) {
    auto const first = static_cast<std::uint32_t>(mesh.positions.size());
    D3 const normal = glm::normalize(glm::cross(along, across));
    for (D2 const t : {D2(0, 0), D2(1, 0), D2(1, 1), D2(0, 1)}) {
        mesh.positions.push_back(corner + t.x * along + t.y * across);
        mesh.normals.push_back(normal);
        mesh.uv.push_back(D2(t.x, 1 - t.y) * repeats);
    }
    add_quad(mesh, first, first + 1, first + 2, first + 3);
}

} // namespace

MeshData make_surface(int columns, int rows, std::function<D3(double, double)> const& surface, D2 repeats) {
    MeshData mesh;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            double const u = double(i) / columns;
            double const v = double(j) / rows;
            mesh.positions.push_back(surface(u, v));
            mesh.uv.push_back(D2(u, v) * repeats);
            // At a pole one difference vanishes: look a little inside instead.
            double const step = 1e-4;
            double const cu = std::clamp(u, 2 * step, 1 - 2 * step);
            double const cv = std::clamp(v, 2 * step, 1 - 2 * step);
            D3 const du = surface(cu + step, cv) - surface(cu - step, cv);
            D3 const dv = surface(cu, cv + step) - surface(cu, cv - step);
            mesh.normals.push_back(glm::normalize(glm::cross(du, dv)));
        }
    }
    auto const index = [columns](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            add_quad(mesh, index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
        }
    }
    return mesh;
}

MeshData make_box(D3 size, double texture_size) {
    MeshData mesh;
    D3 const h = size / 2.0;
    auto const face = [&](D3 corner, D3 along, D3 across) {
        D2 const repeats = texture_size > 0 ? D2(glm::length(along), glm::length(across)) / texture_size : D2(1, 1);
        add_face(mesh, corner, along, across, repeats);
    };
    D3 const x(size.x, 0, 0);
    D3 const y(0, size.y, 0);
    D3 const z(0, 0, size.z);
    face({-h.x, -h.y, h.z}, x, y);
    face({h.x, -h.y, -h.z}, -x, y);
    face({h.x, -h.y, h.z}, -z, y);
    face({-h.x, -h.y, -h.z}, z, y);
    face({-h.x, h.y, h.z}, x, -z);
    face({-h.x, -h.y, -h.z}, x, z);
    return mesh;
}

MeshData make_rounded_box(D3 size, double radius) {
    // A sphere whose octants are moved apart; rows and columns are doubled where they part.
    constexpr int steps = 4;
    double const r = std::min(radius, std::min({size.x, size.y, size.z}) * 0.499);
    D3 const core = size / 2.0 - D3(r);
    MeshData mesh;
    constexpr int columns = 4 * (steps + 1);
    constexpr int rows = 2 * (steps + 1);
    for (int j = 0; j < rows; ++j) {
        bool const lower = j > steps;
        double const polar = (lower ? j - 1 : j) * pi / (2 * steps);
        for (int i = 0; i <= columns; ++i) {
            int const quadrant = (i % columns) / (steps + 1);
            double const angle = (i % columns - quadrant) * pi / (2 * steps);
            D3 const normal(std::sin(polar) * std::sin(angle), std::cos(polar), std::sin(polar) * std::cos(angle));
            D3 const side(quadrant < 2 ? 1 : -1, lower ? -1 : 1, quadrant == 0 || quadrant == 3 ? 1 : -1);
            mesh.positions.push_back(side * core + r * normal);
            mesh.normals.push_back(normal);
            mesh.uv.push_back({double(i) / columns, double(j) / (rows - 1)});
        }
    }
    auto const index = [](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j + 1 < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            add_quad(mesh, index(i, j + 1), index(i + 1, j + 1), index(i + 1, j), index(i, j));
        }
    }
    for (double const side : {1.0, -1.0}) { // the poles' rings leave a rectangle open
        D3 const y(0, side * size.y / 2, 0);
        D3 const along(2 * core.x, 0, 0);
        D3 const across(0, 0, -side * 2 * core.z);
        add_face(mesh, y - along / 2.0 - across / 2.0, along, across, {1, 1});
    }
    return mesh;
}

MeshData make_cylinder(double radius, double height, int segments) {
    std::array<D2, 4> const curve{D2(0, 0), D2(radius, 0), D2(radius, height), D2(0, height)};
    return make_lathe(curve, segments);
}

MeshData make_cone(double radius, double height, int segments) {
    std::array<D2, 2> const curve{D2(radius, 0), D2(0, height)};
    return make_lathe(curve, segments);
}

MeshData make_lathe(std::span<D2 const> curve, int segments) {
    MeshData mesh;
    auto const outward = [&](std::size_t piece) { // of the straight piece from point `piece` to the next
        D2 const along = curve[piece + 1] - curve[piece];
        return glm::normalize(D2(along.y, -along.x));
    };
    double const sharp = std::cos(radians(40));
    for (std::size_t piece = 0; piece + 1 < curve.size(); ++piece) {
        D2 start = outward(piece);
        D2 end = start;
        if (piece > 0 && glm::dot(outward(piece - 1), start) > sharp) {
            start = glm::normalize(outward(piece - 1) + outward(piece));
        }
        if (piece + 2 < curve.size() && glm::dot(outward(piece + 1), end) > sharp) {
            end = glm::normalize(outward(piece + 1) + outward(piece));
        }
        auto const first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i <= segments; ++i) {
            double const angle = 2 * pi * (i % segments) / segments;
            D2 const around(std::sin(angle), std::cos(angle));
            for (auto const& [point, normal, v] :
                 {std::tuple(curve[piece], start, 1.0), {curve[piece + 1], end, 0.0}}) {
                mesh.positions.push_back({around.x * point.x, point.y, around.y * point.x});
                mesh.normals.push_back({around.x * normal.x, normal.y, around.y * normal.x});
                mesh.uv.push_back({double(i) / segments, v});
            }
        }
        for (int i = 0; i < segments; ++i) {
            std::uint32_t const a = first + 2 * static_cast<std::uint32_t>(i);
            add_quad(mesh, a, a + 2, a + 3, a + 1);
        }
    }
    return mesh;
}

MeshData make_sphere(double radius, int segments) {
    MeshData mesh = make_surface(segments, segments / 2, [radius](double u, double v) {
        double const east = 2 * pi * u;
        double const ring = std::sin(pi * v);
        return radius * D3(ring * std::sin(east), -std::cos(pi * v), ring * std::cos(east));
    });
    for (D2& uv : mesh.uv) {
        uv.y = 1 - uv.y;
    }
    return mesh;
}

MeshData make_torus(double major_radius, double minor_radius, int segments, int sides) {
    return make_surface(segments, sides, [=](double u, double v) {
        double const ring = major_radius + minor_radius * std::cos(2 * pi * v);
        return D3(ring * std::sin(2 * pi * u), minor_radius * std::sin(2 * pi * v), ring * std::cos(2 * pi * u));
    });
}

MeshData make_ground(D2 size, double texture_size) {
    MeshData mesh;
    add_face(mesh, {-size.x / 2, 0, size.y / 2}, {size.x, 0, 0}, {0, 0, -size.y}, size / texture_size);
    return mesh;
}

MeshData make_card(D2 size) {
    MeshData mesh;
    add_face(mesh, {-size.x / 2, 0, 0}, {size.x, 0, 0}, {0, size.y, 0}, {1, 1});
    return mesh;
}

void paint(MeshData& mesh, D3 color) {
    mesh.colors.assign(mesh.positions.size(), color);
}

} // namespace framelet
