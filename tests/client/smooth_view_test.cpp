#include "client/smooth_view.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(LateClock, SaysWhatWasReadALagAgo) {
    LateClock clock(0.1);
    EXPECT_EQ(clock.read(5, 20), 20) << "nothing earlier is known";
    EXPECT_EQ(clock.read(5.05, 20.05), 20);
    EXPECT_NEAR(clock.read(5.125, 20.125), 20.025, 1e-9);
    EXPECT_NEAR(clock.read(5.2, 20.2), 20.1, 1e-9);
    // Paused: it arrives, exactly, and stays.
    EXPECT_NEAR(clock.read(5.25, 20.2), 20.15, 1e-9);
    for (double now = 5.3; now < 5.6; now += 0.05) {
        EXPECT_NEAR(clock.read(now + 1e-9, 20.2), 20.2, 1e-9);
    }
    EXPECT_EQ(clock.read(6, 20.2), 20.2);
    // Set back: that shows a lag later.
    EXPECT_EQ(clock.read(6.01, 3), 20.2);
    EXPECT_NEAR(clock.read(6.12, 3.1), 3.01, 1e-2);
}

TEST(LateClock, WithoutALagItIsTheClock) {
    LateClock clock(0);
    EXPECT_EQ(clock.read(1, 7), 7);
    EXPECT_EQ(clock.read(1, 8), 8);
    EXPECT_EQ(clock.read(2, 9), 9);
}

Camera at_x(float x, float turned = 0) {
    Camera camera;
    camera.position.x = x;
    camera.orientation = glm::angleAxis(turned, Vec3(0, 1, 0));
    return camera;
}

TEST(CameraTrack, IsBetweenTheCamerasOfBatches) {
    CameraTrack track;
    EXPECT_TRUE(track.empty());
    track.add(1, at_x(0));
    track.add(2, at_x(4, 0.2f));
    EXPECT_EQ(track.at(0), at_x(0));
    EXPECT_EQ(track.at(1), at_x(0));
    Camera const middle = track.at(1.5);
    EXPECT_FLOAT_EQ(middle.position.x, 2);
    EXPECT_NEAR(glm::dot(middle.orientation, at_x(0, 0.1f).orientation), 1, 1e-6f);
    EXPECT_TRUE(is_valid(middle));
    EXPECT_EQ(track.at(2), at_x(4, 0.2f));
    EXPECT_EQ(track.at(9), at_x(4, 0.2f));
    track.add(2, at_x(5));
    EXPECT_EQ(track.at(2), at_x(5)) << "the newest of one time";
    track.add(0.5, at_x(7)); // the clock was set back
    EXPECT_EQ(track.at(3), at_x(7));
}

TEST(CameraTrack, DoesNotFlyWhereTheCameraCuts) {
    CameraTrack track;
    track.add(1, at_x(0));
    track.add(2, at_x(4, 1.5f));
    EXPECT_EQ(track.at(1.9), at_x(0));
    EXPECT_EQ(track.at(2), at_x(4, 1.5f));
}

TEST(CameraTrack, IsBounded) {
    CameraTrack track;
    for (int i = 0; i < 1000; ++i) {
        track.add(i, at_x(static_cast<float>(i)));
    }
    EXPECT_EQ(track.at(999), at_x(999));
    EXPECT_EQ(track.at(0), at_x(1000 - 256));
}

} // namespace
} // namespace framelet
