// Closed boxes, of which the light is known by mathematics. In: materials. Out: scenes, radiance on their walls.
#pragma once

#include <algorithm>
#include <array>

#include "scene_builder.h"

namespace framelet::test {

inline Material glowing(Vec3 base, Vec3 emissive) {
    Material m = matte(base);
    m.emissive = emissive;
    return m;
}

/// The walls of the cube [0, 1]^3 seen from inside: corner and sides of x = 0, x = 1, y = 0, ..
struct Wall {
    Vec3 corner, side_u, side_v;

    Vec3 normal() const { return glm::cross(side_u, side_v); }
    Vec3 at(float u, float v) const { return corner + side_u * u + side_v * v; }
};
inline constexpr int ceiling = 3;
inline std::array<Wall, 6> cube_walls() {
    Vec3 const x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    return {{{{}, y, z}, {x, z, y}, {{}, z, x}, {y, x, z}, {{}, x, y}, {z, y, x}}};
}

inline Scene cube(Material const& walls) {
    Scene scene;
    scene.materials.push_back(walls);
    for (Wall const& wall : cube_walls()) {
        add(scene, quad(wall.corner, wall.side_u, wall.side_v, 0));
    }
    return scene;
}

/// Form factor from a point to a parallelogram above its horizon: Lambert's sum over edges ([Schröder 1993] has it).
inline double point_form_factor(Vec3 const& at, Vec3 const& normal, Wall const& patch) {
    std::array<glm::dvec3, 4> corners;
    Vec3 const around[] = {patch.at(0, 0), patch.at(1, 0), patch.at(1, 1), patch.at(0, 1)};
    std::transform(std::begin(around), std::end(around), corners.begin(),
                   [&](Vec3 const& corner) { return glm::normalize(glm::dvec3(corner) - glm::dvec3(at)); });
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        glm::dvec3 const& a = corners[k];
        glm::dvec3 const& b = corners[(k + 1) % 4];
        glm::dvec3 const across = glm::cross(a, b);
        double const sine = glm::length(across);
        if (sine > 1e-12) {
            sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across / sine, glm::dvec3(normal));
        }
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

/// A grey box of which the middle third of the ceiling shines, and its radiosity.
class GreyBox {
public:
    static constexpr float albedo = 0.6f, emitted = 4;
    struct Point {
        int wall;
        float u, v;
    };
    static constexpr std::array<Point, 5> points{Point{2, 0.5f, 0.5f}, Point{2, 0.2f, 0.7f}, Point{0, 0.5f, 0.4f},
                                                 Point{5, 0.7f, 0.3f}, Point{ceiling, 0.15f, 0.5f}};

    Scene scene = cube(matte(Vec3(albedo)));

    GreyBox() {
        scene.materials.push_back(glowing(Vec3(albedo), Vec3(emitted)));
        Wall const& top = walls_[ceiling];
        add(scene, quad(top.at(1.0f / 3, 1.0f / 3) + top.normal() * 1e-4f, top.side_u / 3.0f, top.side_v / 3.0f, 1));
        for (int w = 0; w < 6; ++w) {
            for (int i = 0; i < side * side; ++i) {
                int const x = i % side, y = i / side;
                Wall const& wall = walls_[static_cast<std::size_t>(w)];
                bool const shines = w == ceiling && x / (side / 3) == 1 && y / (side / 3) == 1;
                patches_.push_back(
                    {{wall.at(float(x) / side, float(y) / side), wall.side_u / float(side), wall.side_v / float(side)},
                     w,
                     shines ? double(emitted) : 0.0,
                     0});
            }
        }
        std::vector<std::vector<double>> factors;
        for (Patch const& patch : patches_) {
            factors.push_back(factors_at(patch.area.at(0.5f, 0.5f), patch.wall));
        }
        for (int iteration = 0; iteration < 40; ++iteration) { // the rest is below 0.6^40
            for (std::size_t i = 0; i < patches_.size(); ++i) {
                patches_[i].radiance = patches_[i].emitted + double(albedo) * arriving(factors[i]);
            }
        }
    }

    /// Irradiance / pi at a point of a wall.
    double arriving(Point const& p) const {
        return arriving(factors_at(walls_[static_cast<std::size_t>(p.wall)].at(p.u, p.v), p.wall));
    }
    /// Radiance of a point that does not shine.
    double radiance(Point const& p) const { return double(albedo) * arriving(p); }

private:
    static constexpr int side = 12; ///< patches along a wall
    struct Patch {
        Wall area;
        int wall;
        double emitted, radiance;
    };

    std::vector<double> factors_at(Vec3 const& at, int wall) const {
        Vec3 const normal = walls_[static_cast<std::size_t>(wall)].normal();
        std::vector<double> out;
        for (Patch const& patch : patches_) {
            out.push_back(patch.wall == wall ? 0 : point_form_factor(at, normal, patch.area));
        }
        return out;
    }
    double arriving(std::vector<double> const& factors) const {
        double sum = 0;
        for (std::size_t i = 0; i < patches_.size(); ++i) {
            sum += factors[i] * patches_[i].radiance;
        }
        return sum;
    }

    std::array<Wall, 6> walls_ = cube_walls();
    std::vector<Patch> patches_;
};

} // namespace framelet::test
