#include "scenes/things/vehicle.h"

#include <cmath>

#include "scenes/mesh/mesh_builder.h"

namespace framelet {
namespace {

/// A solid about the Y axis whose axis becomes X: what pointed to +Y points to the car's left.
MeshData turned_to_axle(MeshData mesh) {
    MeshData turned;
    append(turned, mesh, {{0, 0, 0}, rotation_about({0, 0, 1}, -pi / 2), {1, 1, 1}});
    turned.uv.clear();
    return turned;
}

MeshData make_tyre() {
    std::array<D2, 10> const profile{D2(0.225, -0.085), D2(0.25, -0.105), D2(0.30, -0.11),  D2(0.327, -0.095),
                                     D2(0.34, -0.07),   D2(0.34, 0.07),   D2(0.327, 0.095), D2(0.30, 0.11),
                                     D2(0.25, 0.105),   D2(0.225, 0.085)};
    return turned_to_axle(make_lathe(profile, 40));
}

MeshData make_rim_bed() {
    std::array<D2, 3> const profile{D2(0.226, 0.086), D2(0.20, -0.05), D2(0, -0.05)};
    MeshData bed = make_lathe(profile, 32);
    std::array<D2, 4> const brake_profile{D2(0.15, -0.05), D2(0.15, 0.0), D2(0.06, 0.0), D2(0.06, 0.02)};
    append(bed, make_lathe(brake_profile, 32));
    return turned_to_axle(bed);
}

MeshData make_rim() {
    MeshData rim = make_torus(0.219, 0.011, 40, 8);
    for (D3& position : rim.positions) {
        position.y += 0.084;
    }
    std::array<D2, 5> const hub{D2(0.062, -0.02), D2(0.06, 0.07), D2(0.05, 0.085), D2(0.03, 0.092), D2(0, 0.094)};
    append(rim, make_lathe(hub, 20));
    for (int spoke = 0; spoke < wheel_spokes; ++spoke) {
        for (double const apart : {-0.13, 0.13}) { // each spoke is a narrow pair
            double const angle = 2 * pi * spoke / wheel_spokes + apart;
            MeshData const bar = make_rounded_box({0.028, 0.03, 0.185}, 0.01);
            DQuat const outward = rotation_about({0, 1, 0}, angle) * rotation_about({1, 0, 0}, radians(4));
            append(rim, bar, {{0.128 * std::sin(angle), 0.068, 0.128 * std::cos(angle)}, outward, {1, 1, 1}});
        }
    }
    return turned_to_axle(rim);
}

} // namespace

VehicleMeshes add_vehicle_meshes(GltfDocument& document, D3 paint_color) {
    VehicleBody body = make_vehicle_body();
    int const paint = document.add_material(
        {.name = "paint", .base_color = paint_color, .metallic = 0.4, .roughness = 0.06, .double_sided = true});
    int const glass = document.add_material({.name = "glass", .base_color = D3(0.015, 0.02, 0.025), .roughness = 0.03});
    int const trim =
        document.add_material({.name = "trim", .base_color = D3(0.02), .roughness = 0.6, .double_sided = true});
    int const head = document.add_material({.name = "head lamp", .base_color = D3(0.8), .roughness = 0.05});
    int const tail =
        document.add_material({.name = "tail lamp", .base_color = D3(0.10, 0.004, 0.004), .roughness = 0.03});
    int const plate = document.add_material({.name = "plate", .base_color = D3(0.7), .roughness = 0.4});
    int const rubber = document.add_material({.name = "rubber", .base_color = D3(0.03), .roughness = 0.8});
    int const metal =
        document.add_material({.name = "rim", .base_color = D3(0.78, 0.79, 0.81), .metallic = 1, .roughness = 0.22});
    int const dark =
        document.add_material({.name = "rim bed", .base_color = D3(0.06), .metallic = 0.5, .roughness = 0.5});
    VehicleMeshes meshes;
    meshes.body = document.add_mesh("car body", {{std::move(body.paint), paint},
                                                 {std::move(body.glass), glass},
                                                 {std::move(body.trim), trim},
                                                 {std::move(body.head_lamps), head},
                                                 {std::move(body.tail_lamps), tail},
                                                 {std::move(body.plate), plate}});
    meshes.wheel = document.add_mesh("wheel", {{make_tyre(), rubber}, {make_rim_bed(), dark}, {make_rim(), metal}});
    return meshes;
}

Vehicle add_vehicle(GltfDocument& document, VehicleMeshes const& meshes, Placement const& place) {
    Vehicle vehicle;
    vehicle.root = document.add_node({.name = "car", .place = place});
    document.add_node({.name = "body", .mesh = meshes.body}, vehicle.root);
    for (int i = 0; i < 4; ++i) {
        bool const left = i % 2 == 0;
        D3 const hub(left ? 0.73 : -0.73, wheel_radius, i < 2 ? front_axle_z : rear_axle_z);
        int const axle = document.add_node({.name = "axle", .place = {.translation = hub}}, vehicle.root);
        DQuat const facing = left ? DQuat(1, 0, 0, 0) : rotation_about({0, 1, 0}, pi);
        document.add_node({.name = "wheel", .place = {.rotation = facing}, .mesh = meshes.wheel}, axle);
        vehicle.wheels[static_cast<std::size_t>(i)] = axle;
    }
    return vehicle;
}

} // namespace framelet
