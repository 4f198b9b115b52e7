#include "scenes/things/vehicle_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include "scenes/mesh/mesh_builder.h"

namespace framelet {
namespace {

constexpr double half_length = 2.25;
constexpr double half_width = 0.91;
constexpr double waist_height = 0.55; // where the body is widest
constexpr double sill_height = 0.21;
constexpr double arch_radius = 0.40;
constexpr double lowest_angle = -0.6; // of a cross-section: at the sill
constexpr double belt_height = 0.88; // where the cabin starts, inside the body

/// Smooth curve through (z, height) points, z increasing (cubic Hermite, tangents from the neighbours).
double curve_through(std::span<D2 const> points, double z) {
    std::size_t last = 1;
    while (last + 1 < points.size() && points[last].x < z) {
        ++last;
    }
    auto const tangent = [&](std::size_t i) {
        D2 const before = points[i == 0 ? 0 : i - 1];
        D2 const after = points[std::min(i + 1, points.size() - 1)];
        return (after.y - before.y) / (after.x - before.x);
    };
    D2 const a = points[last - 1];
    D2 const b = points[last];
    double const width = b.x - a.x;
    double const t = std::clamp((z - a.x) / width, 0.0, 1.0);
    double const t2 = t * t;
    double const t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a.y + (t3 - 2 * t2 + t) * width * tangent(last - 1) + (3 * t2 - 2 * t3) * b.y +
           (t3 - t2) * width * tangent(last);
}

/// Radius of the unit superellipse of this exponent in a direction: 2 is a circle, more is squarer.
double superellipse(double angle, double exponent) {
    return std::pow(std::pow(std::abs(std::cos(angle)), exponent) + std::pow(std::abs(std::sin(angle)), exponent),
                    -1 / exponent);
}

/// Factor that rounds off the car's ends: 1 in its middle, 0 at its ends.
double rounding(double z, double exponent, double root) {
    return std::pow(std::max(0.0, 1 - std::pow(std::min(std::abs(z) / half_length, 1.0), exponent)), 1 / root);
}

/// A point of the body: bonnet, shoulders, boot. The angle runs from the left side (0) over the top to the right side
/// (pi); below 0 and above pi the sides tuck in towards the sill.
D3 body_point(double z, double angle) {
    static constexpr std::array<D2, 8> top{D2(-2.25, 0.95), D2(-1.75, 0.99), D2(-0.8, 0.95), D2(0.3, 0.92),
                                           D2(0.95, 0.91),  D2(1.55, 0.84),  D2(2.0, 0.76),  D2(2.25, 0.70)};
    double const width = half_width * rounding(z, 6, 3);
    double const closing = rounding(z, 14, 3);
    double const below = std::max(-angle, angle - pi);
    if (below > 0) {
        double const tuck = below / -lowest_angle;
        double const side = angle < 0 ? 1 : -1;
        return {side * width * (1 - 0.07 * tuck * tuck), waist_height - (waist_height - sill_height) * closing * tuck,
                z};
    }
    double const radius = superellipse(angle, 3.6);
    double const height = (curve_through(top, z) - waist_height) * closing;
    return {width * radius * std::cos(angle), waist_height + height * radius * std::sin(angle), z};
}

/// A point of the cabin: windows and roof.
D3 cabin_point(double z, double angle) {
    static constexpr std::array<D2, 8> roof{D2(-1.98, 0.90), D2(-1.7, 1.02), D2(-1.15, 1.27), D2(-0.65, 1.38),
                                            D2(-0.1, 1.41),  D2(0.22, 1.36), D2(0.62, 1.15),  D2(1.04, 0.88)};
    double const radius = superellipse(angle, 3.2);
    double const rise = std::max(curve_through(roof, z) - belt_height, 0.001);
    double const width = 0.80 - 0.035 * z * z - (z < 0 ? 0.01 * z * z : 0);
    double const y = belt_height + rise * radius * std::sin(angle);
    return {width * radius * std::cos(angle) * (1 - 0.36 * (y - belt_height)), y, z};
}

/// The height below which nothing is left of the sides: the sill, or the arch of a wheel.
double lower_edge(double z) {
    for (double const axle : {front_axle_z, rear_axle_z}) {
        double const offset = std::abs(z - axle);
        if (offset < arch_radius) {
            return wheel_radius + std::sqrt(arch_radius * arch_radius - offset * offset);
        }
    }
    return 0;
}

double lowest_angle_at(double z) {
    double const edge = lower_edge(z);
    double low = lowest_angle;
    double high = pi / 2;
    if (body_point(z, low).y >= edge) {
        return low;
    }
    for (int i = 0; i < 50; ++i) {
        double const middle = 0.5 * (low + high);
        (body_point(z, middle).y < edge ? low : high) = middle;
    }
    return low;
}

using SurfacePoint = std::function<D3(double z, double angle)>;

/// A grid over stations (z) and rows of angles, with the normals of the surface.
struct Loft {
    std::vector<double> stations;
    int rows = 0;
    MeshData vertices; ///< station-major, rows + 1 a station
    std::vector<double> angles;
};

Loft make_loft(std::vector<double> stations, int rows, SurfacePoint const& point,
               std::function<double(double)> const& first_angle) {
    Loft loft{std::move(stations), rows, {}, {}};
    for (double const z : loft.stations) {
        double const first = first_angle(z);
        for (int row = 0; row <= rows; ++row) {
            double const angle = first + (pi - 2 * first) * row / rows;
            double const step = 1e-4;
            double const inner = std::clamp(z, loft.stations.front() + 0.004, loft.stations.back() - 0.004);
            D3 const along = point(inner + step, angle) - point(inner - step, angle);
            D3 const around = point(inner, angle + step) - point(inner, angle - step);
            loft.vertices.positions.push_back(point(z, angle));
            loft.vertices.normals.push_back(glm::normalize(glm::cross(around, along)));
            loft.angles.push_back(angle);
        }
    }
    return loft;
}

/// Deals the loft's quads out to parts: `choose` gets z and angle at the middle of each.
void deal_out(Loft const& loft, std::function<MeshData*(double z, double angle)> const& choose) {
    std::map<std::pair<MeshData*, std::uint32_t>, std::uint32_t> placed;
    auto const index_in = [&](MeshData* part, std::uint32_t vertex) {
        auto const [at, is_new] =
            placed.try_emplace({part, vertex}, static_cast<std::uint32_t>(part->positions.size()));
        if (is_new) {
            part->positions.push_back(loft.vertices.positions[vertex]);
            part->normals.push_back(loft.vertices.normals[vertex]);
        }
        return at->second;
    };
    auto const width = static_cast<std::size_t>(loft.rows) + 1;
    for (std::size_t s = 0; s + 1 < loft.stations.size(); ++s) {
        for (std::size_t r = 0; r + 1 < width; ++r) {
            std::size_t const a = s * width + r;
            MeshData* const part = choose((loft.stations[s] + loft.stations[s + 1]) / 2,
                                          (loft.angles[a] + loft.angles[a + 1 + width]) / 2);
            for (std::size_t const corner : {a, a + 1, a + 1 + width, a, a + 1 + width, a + width}) {
                part->indices.push_back(index_in(part, static_cast<std::uint32_t>(corner)));
            }
        }
    }
}

std::vector<double> body_stations() {
    std::vector<double> stations;
    for (int i = -20; i <= 20; ++i) {
        double const z = half_length * std::sin(pi / 2 * i / 20);
        bool const in_arch =
            std::abs(z - front_axle_z) < arch_radius + 0.03 || std::abs(z - rear_axle_z) < arch_radius + 0.03;
        if (!in_arch) {
            stations.push_back(z);
        }
    }
    for (double const axle : {front_axle_z, rear_axle_z}) {
        for (int i = 0; i <= 16; ++i) {
            stations.push_back(axle + arch_radius * 0.9999 * std::cos(pi * i / 16));
        }
        stations.push_back(axle + arch_radius * 1.001); // the step from the sill up into the arch
        stations.push_back(axle - arch_radius * 1.001);
    }
    std::sort(stations.begin(), stations.end());
    return stations;
}

std::vector<double> cabin_stations() {
    std::vector<double> stations;
    for (double z = -1.95; z < 1.03; z += 0.075) {
        stations.push_back(z);
    }
    stations.push_back(1.03);
    return stations;
}

void add_wheel_wells(MeshData& trim) {
    for (double const axle : {front_axle_z, rear_axle_z}) {
        for (double const side : {1.0, -1.0}) {
            MeshData well = make_surface(20, 1, [&](double u, double v) {
                double const angle = radians(-25 + 230 * u) * side + (side < 0 ? pi : 0);
                return D3(side * (0.45 + 0.37 * v), wheel_radius + arch_radius * std::sin(angle),
                          axle + arch_radius * std::cos(angle));
            });
            well.uv.clear();
            append(trim, well);
        }
    }
    auto const add_block = [&](D3 size, D3 center) {
        MeshData block = make_box(size);
        block.uv.clear();
        append(trim, block, {center});
    };
    add_block({1.5, 0.3, 1.85}, {0, 0.36, 0.015});
    add_block({0.9, 0.5, 4.0}, {0, 0.45, 0});
}

} // namespace

VehicleBody make_vehicle_body() {
    VehicleBody body;
    // The surface is cut into parts by z and by the angle from the side (0) to the middle of the top (90 degrees).
    auto const side_angle = [](double angle) { return std::min(angle, pi - angle) * 180 / pi; };
    Loft const shell = make_loft(body_stations(), 48, body_point, lowest_angle_at);
    deal_out(shell, [&](double z, double angle) {
        double const side = side_angle(angle);
        bool const lamp = side > 22 && side < 52;
        if (z > 1.78 && z < 2.16 && lamp) {
            return &body.head_lamps;
        }
        if (z < -1.98 && z > -2.2 && side > 8 && side < 44) {
            return &body.tail_lamps;
        }
        bool const grille = z > 2.12 && side < 8 && side > -22;
        return grille || side < -24 ? &body.trim : &body.paint;
    });
    Loft const cabin = make_loft(cabin_stations(), 40, cabin_point, [](double) { return 0.0; });
    deal_out(cabin, [&](double z, double angle) {
        double const side = side_angle(angle);
        if (z > 0.24 || z < -1.12) { // windscreen and rear window, with the pillars at their sides
            return side > 36 ? &body.glass : &body.paint;
        }
        bool const roof = side > 46;
        bool const pillar = z > -0.45 && z < -0.37;
        return roof ? &body.paint : pillar ? &body.trim : &body.glass;
    });
    add_wheel_wells(body.trim);
    for (double const side : {1.0, -1.0}) { // mirrors
        MeshData mirror = make_rounded_box({0.2, 0.13, 0.12}, 0.055);
        mirror.uv.clear();
        append(body.paint, mirror, {{side * 0.93, 0.98, 0.62}});
    }
    MeshData plate = make_rounded_box({0.5, 0.11, 0.03}, 0.01);
    plate.uv.clear();
    append(body.plate, plate, {{0, 0.48, -2.255}});
    return body;
}

} // namespace framelet
