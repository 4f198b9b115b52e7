#include "client/video/video_clock.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(PictureRate, IsAFractionOfWholeNumbers) {
    EXPECT_EQ(PictureRate::of(60), (PictureRate{60, 1}));
    EXPECT_EQ(PictureRate::of(0.1), (PictureRate{1, 10}));
    EXPECT_EQ(PictureRate::of(59.94), (PictureRate{2997, 50}));
    EXPECT_EQ(PictureRate::of(1000), (PictureRate{1000, 1}));
}

TEST(VideoClock, GivesEachPictureItsPlaceWhereAllAreInTime) {
    VideoClock clock(PictureRate::of(10));
    int number = 0;
    for (double const late : {0.0, 0.04, 0.0, -0.04, 0.0}) { // less than half a place makes no difference
        EXPECT_EQ(clock.show(0.1 * number++ + late), (VideoClock::Places{0, true}));
    }
}

TEST(VideoClock, RepeatsThePictureBeforeALateOne) {
    VideoClock clock(PictureRate::of(10));
    clock.show(0);
    EXPECT_EQ(clock.show(0.5), (VideoClock::Places{4, true}));
    EXPECT_EQ(clock.show(0.6), (VideoClock::Places{0, true}));
}

TEST(VideoClock, LeavesOutWhatComesTooSoon) {
    VideoClock clock(PictureRate::of(10));
    clock.show(0);
    EXPECT_EQ(clock.show(0.01), (VideoClock::Places{0, false}));
    EXPECT_EQ(clock.show(0.1), (VideoClock::Places{0, true}));
}

} // namespace
} // namespace framelet
