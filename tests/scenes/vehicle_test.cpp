#include "scenes/things/vehicle.h"

#include <gtest/gtest.h>

#include "scenes/things/vehicle_body.h"
#include "scenes/vehicle_scenes.h"

namespace framelet {
namespace {

struct Box {
    D3 lower{1e9}, upper{-1e9};

    void include(MeshData const& mesh) {
        for (D3 const& position : mesh.positions) {
            lower = glm::min(lower, position);
            upper = glm::max(upper, position);
        }
    }
};

TEST(Vehicle, StandsOnTheGroundAndHasTheSizeOfACar) {
    VehicleBody const body = make_vehicle_body();
    Box box;
    for (MeshData const* part : {&body.paint, &body.glass, &body.trim, &body.head_lamps, &body.tail_lamps}) {
        box.include(*part);
    }
    EXPECT_GT(box.lower.y, 0.1) << "ground clearance";
    EXPECT_NEAR(box.upper.y, 1.4, 0.05);
    EXPECT_NEAR(box.upper.z - box.lower.z, 4.5, 0.05);
    EXPECT_NEAR(box.upper.x, -box.lower.x, 1e-9);

    GltfDocument document;
    Vehicle const car = add_vehicle(document, add_vehicle_meshes(document, {1, 0, 0}));
    int const mesh = document.meshes.size() == 2 ? 1 : 0;
    Box wheel;
    for (GltfPrimitive const& primitive : document.meshes[static_cast<std::size_t>(mesh)].primitives) {
        wheel.include(primitive.data);
    }
    for (int const axle : car.wheels) {
        double const height = document.nodes[static_cast<std::size_t>(axle)].place.translation.y;
        EXPECT_NEAR(height + wheel.lower.y, 0, 1e-3);
    }
}

TEST(Vehicle, SurfaceNormalsPointOutward) {
    VehicleBody const body = make_vehicle_body();
    for (MeshData const* part : {&body.paint, &body.glass}) {
        std::size_t agreeing = 0;
        for (std::size_t i = 0; i < part->indices.size(); i += 3) {
            D3 const& a = part->positions[part->indices[i]];
            D3 const face =
                glm::cross(part->positions[part->indices[i + 1]] - a, part->positions[part->indices[i + 2]] - a);
            agreeing += glm::dot(face, part->normals[part->indices[i]]) > 0 ? 1 : 0;
        }
        EXPECT_GT(double(agreeing), 0.98 * double(part->indices.size() / 3));
    }
    // The left side faces left, the roof up.
    for (std::size_t i = 0; i < body.paint.positions.size(); ++i) {
        D3 const& p = body.paint.positions[i];
        if (p.y > 1.37) {
            EXPECT_GT(body.paint.normals[i].y, 0.5);
        }
        if (p.x > 0.89 && p.y < 0.8) {
            EXPECT_GT(body.paint.normals[i].x, 0.5);
        }
    }
}

TEST(VehicleScene, WheelsRollAsFarAsTheCarDrives) {
    GltfDocument const document = make_vehicle_scene({.cars = {{.speed = 24}}, .eye = {5, 2, 5}});
    ASSERT_EQ(document.tracks.size(), 2u);
    double const distance = document.tracks[0].values.back().z - document.tracks[0].values.front().z;
    EXPECT_NEAR(distance, 120, 1e-9);
    auto const quarter_turns = static_cast<double>(document.tracks[1].times.size() - 1);
    EXPECT_NEAR(quarter_turns * pi / 2 * wheel_radius, distance, 0.01 * distance);
}

} // namespace
} // namespace framelet
