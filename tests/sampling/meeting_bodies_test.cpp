#include "server/sampling/field/meeting_bodies.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace framelet {
namespace {

constexpr Viewport viewport{64, 64};
constexpr BodyNumber car = 7, other = 8;

/// A track of two keys, between which the body goes by `way`.
BodyTrack going(BodyNumber body, Vec3 way) {
    return {body, 0, {{Vec3(0)}, {way}}};
}

/// A framelet with the first `count` samples on one body, the rest on another, all 4 metres away.
Framelet parted(BodyNumber first, BodyNumber second, std::size_t count = framelet_samples / 2) {
    Framelet framelet;
    framelet.tile = make_tile(2, 1, 1);
    framelet.depth.fill(4);
    framelet.body.assign(framelet_samples, second);
    std::fill_n(framelet.body.begin(), count, first);
    return framelet;
}

class MeetingBodies : public testing::Test {
protected:
    MeetingBodies() {
        motions.extend(going(car, Vec3(0.05f, 0, 0)));
        motions.extend(going(other, Vec3(0.05f, 0, 0)));
    }

    float speed(Framelet const& framelet, std::size_t first = 0, std::size_t count = framelet_samples) const {
        return meeting_speed(framelet, ImagePlane(viewport), {make_view_rays(Camera{}, viewport), 0, &motions}, first,
                             count);
    }

    BodyMotions motions;
};

TEST_F(MeetingBodies, PassAtTheDifferenceOfTheirSpeedsInThePicture) {
    ViewRays const rays = make_view_rays(Camera{}, viewport);
    float const pixels = 0.05f / 4 / glm::length(rays.direction_dx) * body_keys_per_second;
    EXPECT_NEAR(speed(parted(car, static_body)), pixels, 1e-3f * pixels);
    EXPECT_EQ(speed(parted(car, other)), 0) << "they go together";
}

TEST_F(MeetingBodies, AreLookedForInTheirPartOnly) {
    Framelet const framelet = parted(car, static_body, 64);
    EXPECT_EQ(speed(framelet, 0, 64), 0);
    EXPECT_EQ(speed(framelet, 64, 192), 0);
    EXPECT_GT(speed(framelet, 0, 128), 0);
}

TEST_F(MeetingBodies, DoNotWhereTheViewerMovesNothing) {
    Framelet framelet = parted(car, static_body);
    EXPECT_EQ(meeting_speed(framelet, ImagePlane(viewport), {}, 0, framelet_samples), 0);
    framelet.body.clear();
    EXPECT_EQ(speed(framelet), 0);
}

TEST_F(MeetingBodies, AnyDepthGivesAFiniteSpeed) {
    for (float const depth : {0.0f, 1e-30f, 1e30f, INFINITY, std::numeric_limits<float>::quiet_NaN()}) {
        Framelet framelet = parted(car, static_body);
        framelet.depth.fill(depth);
        EXPECT_TRUE(std::isfinite(speed(framelet)));
        EXPECT_GE(speed(framelet), 0);
    }
}

} // namespace
} // namespace framelet
