#include "client/window/resize.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(SteadySize, AsksForASizeOnceTheWindowRests) {
    SteadySize size({640, 360});
    EXPECT_EQ(size.update({640, 360}, 5), (Viewport{640, 360}));
    EXPECT_FALSE(size.waits());
    for (int i = 1; i <= 20; ++i) { // it is being dragged
        EXPECT_EQ(size.update({640 + i, 360}, 5 + 0.05 * i), (Viewport{640, 360}));
        EXPECT_TRUE(size.waits());
    }
    EXPECT_EQ(size.update({660, 360}, 6.05), (Viewport{640, 360}));
    EXPECT_EQ(size.update({660, 360}, 6.2), (Viewport{660, 360}));
    EXPECT_FALSE(size.waits());
}

TEST(SteadySize, OneThatComesBackNeedsNothing) {
    SteadySize size({640, 360});
    size.update({641, 360}, 1);
    size.update({640, 360}, 1.05);
    EXPECT_FALSE(size.waits());
}

TEST(OldPicture, IsShownUntilTheNewOneHasNoHoles) {
    OldPicture old;
    EXPECT_FALSE(old.is_better(false, 0.1, 1));
    EXPECT_TRUE(old.is_better(true, 0.1, 2));
    EXPECT_TRUE(old.is_better(true, 0.9, 2.5));
    EXPECT_FALSE(old.is_better(true, 1, 2.6));
    EXPECT_FALSE(old.is_better(false, 0.2, 2.7)); // holes of one's own are shown
}

TEST(OldPicture, IsNotShownForEver) {
    OldPicture old;
    EXPECT_TRUE(old.is_better(true, 0.1, 2));
    EXPECT_TRUE(old.is_better(true, 0.1, 2.9));
    EXPECT_FALSE(old.is_better(true, 0.1, 3.1));
    EXPECT_FALSE(old.is_better(false, 0.1, 3.2));
    EXPECT_TRUE(old.is_better(true, 0.1, 9)); // another change
}

} // namespace
} // namespace framelet
