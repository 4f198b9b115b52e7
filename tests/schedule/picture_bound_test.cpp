#include "server/schedule/picture_bound.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/reprojection.h"

namespace framelet {
namespace {

constexpr Viewport viewport{64, 64};
constexpr BodyNumber car = 7;
constexpr float seconds = 0.05f;

/// A camera that goes so far, and turns, in `seconds`.
Camera camera_at(double time) {
    Camera camera;
    auto const share = static_cast<float>(time / static_cast<double>(seconds));
    camera.position = share * Vec3(0.1f, 0.02f, -0.05f);
    camera.orientation = glm::angleAxis(0.01f * share, Vec3(0, 1, 0));
    return camera;
}

/// At scene time `seconds`, as much after the camera set off.
RenderedMoment moment_of(BodyMotions const& motions) {
    return {make_view_rays(camera_at(static_cast<double>(seconds)), viewport),
            static_cast<double>(seconds),
            &motions,
            make_view_rays(camera_at(0), viewport),
            0,
            seconds};
}

Framelet seen_at(float depth) {
    Framelet framelet;
    framelet.tile = make_tile(2, 1, 1);
    framelet.depth.fill(depth);
    return framelet;
}

float speed_of(Framelet const& framelet, RenderedMoment const& moment) {
    return carried_speed(framelet, ImagePlane(viewport), moment, 0, framelet_samples);
}

TEST(CarriedSpeed, IsThatOfTheSurfaceInThePicture) {
    BodyMotions motions;
    RenderedMoment moment = moment_of(motions);
    moment.rays = make_view_rays(Camera{}, viewport);
    moment.rays_before = moment.rays;
    moment.rays_before.origin.x -= 0.1f;
    float const pixels = 0.1f / 4 / glm::length(moment.rays.direction_dx) / seconds;
    EXPECT_NEAR(speed_of(seen_at(4), moment), pixels, 1e-3f * pixels);
    EXPECT_EQ(speed_of(seen_at(INFINITY), moment), 0) << "the sky";

    motions.extend({car, 0, {{Vec3(0)}, {Vec3(0.1f, 0, 0)}, {Vec3(0.2f, 0, 0)}, {Vec3(0.3f, 0, 0)}}});
    moment.scene_time = 2.0 / body_keys_per_second;
    Framelet framelet = seen_at(4);
    framelet.body.assign(framelet_samples, car);
    moment.rays_before.origin.x = moment.rays.origin.x - 0.2f; // with the car
    EXPECT_NEAR(speed_of(framelet, moment), 0, 1e-2f * pixels);
}

TEST(CarriedSpeed, IsNothingWhereTheViewerMovesNothingAndAlwaysFinite) {
    BodyMotions const motions;
    RenderedMoment moment = moment_of(motions);
    for (float const depth : {0.0f, 1e-30f, 1e30f, INFINITY, std::numeric_limits<float>::quiet_NaN()}) {
        float const speed = speed_of(seen_at(depth), moment);
        EXPECT_TRUE(std::isfinite(speed));
        EXPECT_GE(speed, 0);
    }
    moment.scene_time_before = moment.scene_time;
    EXPECT_EQ(speed_of(seen_at(4), moment), 0) << "only the user moves the camera";
    moment.scene_time_before = 0;
    EXPECT_GT(speed_of(seen_at(4), moment), 0);
    moment.seconds = 0;
    EXPECT_EQ(speed_of(seen_at(4), moment), 0);
    moment.seconds = seconds;
    moment.motions = nullptr;
    EXPECT_EQ(speed_of(seen_at(4), moment), 0);
}

TEST(CarriedChange, WhatHardlyChangesThoughItShouldHaveStays) {
    PlaceModel model;
    model.energy.fill(0.01f);
    Observation seen;
    seen.level = pixel_level;
    seen.seconds = 0.02f;
    seen.has_change = true;
    float const expected = carried_change(model, seen, 400).expected;
    EXPECT_GT(expected, 0.01f);
    seen.mean_change = 0.1f * expected;
    EXPECT_TRUE(stays(carried_change(model, seen, 400)));
    EXPECT_FALSE(stays(carried_change(model, seen, 0))) << "nothing goes by";
    seen.mean_change = expected;
    EXPECT_FALSE(stays(carried_change(model, seen, 400))) << "it goes by as well";
    model.energy.fill(0);
    seen.mean_change = 0;
    EXPECT_FALSE(stays(carried_change(model, seen, 400))) << "nothing is to be seen there";
    seen.has_change = false;
    EXPECT_FALSE(stays(carried_change(model, seen, 400))) << "nothing is known";
}

/// The viewer moves the bound layer on: while the camera goes as it went, it is where it was.
TEST(BindToPicture, ABoundLayerStaysInPlace) {
    BodyMotions const motions;
    RenderedMoment const moment = moment_of(motions);
    ImagePlane const plane(viewport);
    Tile const tile = make_tile(2, 2, 1);
    PixelRect const rect = plane.tile_rect(tile);
    FrameletShape shape;
    shape.layer_count = 2;
    shape.layers[0] = {.at = 0.2f, .dx = 1e-3f, .dy = 2e-3f};
    shape.layers[1] = {.at = 0.3f, .body = car};
    shape.loose_samples = {{.inverse_depth = 0.25f}, {.inverse_depth = 0.25f, .velocity = Vec3(1, 0, 0)}};
    bind_to_picture(tile, plane, moment, shape);
    EXPECT_EQ(shape.layers[1].velocity, Vec3(0)) << "its body carries it";
    EXPECT_EQ(shape.loose_samples[1].velocity, Vec3(1, 0, 0)) << "it deforms";

    Vec2 const middle(0.5f * static_cast<float>(rect.left + rect.right),
                      0.5f * static_cast<float>(rect.top + rect.bottom));
    auto const off = [&](double inverse_depth, Vec3 velocity) {
        ViewRays const later = make_view_rays(camera_at(1.5 * static_cast<double>(seconds)), viewport);
        glm::dvec3 const drift = 0.5 * static_cast<double>(seconds) * glm::dvec3(velocity);
        glm::dvec3 const to = make_view_transform(moment.rays, later, {}, drift).map(middle.x, middle.y, inverse_depth);
        return glm::distance(glm::dvec2(to) / to.z, glm::dvec2(middle));
    };
    double const at_middle = 0.2 + 8 * 1e-3 + 8 * 2e-3;
    EXPECT_GT(off(at_middle, Vec3(0)), 0.2);
    EXPECT_LT(off(at_middle, shape.layers[0].velocity), 0.02);
    EXPECT_LT(off(0.25, shape.loose_samples[0].velocity), 0.02);
}

/// A velocity from before a cut would carry framelets off as long as they are held.
TEST(BindToPicture, ACutIsNoMotion) {
    BodyMotions const motions;
    RenderedMoment moment = moment_of(motions);
    FrameletShape shape;
    shape.layer_count = 1;
    shape.layers[0].at = 0.2f;
    shape.loose_samples = {{.inverse_depth = 0.25f}};
    FrameletShape const before = shape;
    moment.rays_before.origin.x += 20;
    bind_to_picture(make_tile(2, 2, 1), ImagePlane(viewport), moment, shape);
    EXPECT_EQ(shape, before);
    Camera turned = camera_at(0);
    turned.orientation = glm::angleAxis(1.0f, Vec3(0, 1, 0));
    moment.rays_before = make_view_rays(turned, viewport);
    bind_to_picture(make_tile(2, 2, 1), ImagePlane(viewport), moment, shape);
    EXPECT_EQ(shape, before);
}

TEST(BindToPicture, DoesNothingWhereNoTimePasses) {
    BodyMotions const motions;
    FrameletShape shape;
    shape.layer_count = 1;
    shape.layers[0].at = 0.2f;
    FrameletShape const before = shape;
    RenderedMoment moment = moment_of(motions);
    moment.scene_time_before = moment.scene_time;
    bind_to_picture(make_tile(2, 1, 1), ImagePlane(viewport), moment, shape);
    EXPECT_EQ(shape, before);
    moment = moment_of(motions);
    moment.seconds = 0;
    bind_to_picture(make_tile(2, 1, 1), ImagePlane(viewport), moment, shape);
    EXPECT_EQ(shape, before);
    shape.layers[0].at = 0; // infinitely far
    bind_to_picture(make_tile(2, 1, 1), ImagePlane(viewport), moment_of(motions), shape);
    EXPECT_EQ(shape.layers[0].velocity, Vec3(0));
}

} // namespace
} // namespace framelet
