#include "server/session/clock/scene_control.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(SceneControl, TheFirstHasItAndThenTheNext) {
    SceneControl control(ControlRule::first);
    EXPECT_FALSE(control.controls(1));
    for (std::uint64_t id : {3u, 4u, 7u}) {
        control.enter(id, id, false);
    }
    EXPECT_TRUE(control.controls(3));
    EXPECT_FALSE(control.controls(4));
    control.leave(4);
    EXPECT_TRUE(control.controls(3));
    control.leave(3);
    EXPECT_FALSE(control.controls(3));
    EXPECT_TRUE(control.controls(7));
    control.leave(7);
    control.enter(8, 8, false);
    EXPECT_TRUE(control.controls(8));
}

TEST(SceneControl, WhoComesBackHasItAgain) {
    SceneControl control(ControlRule::first);
    control.enter(1, 1, false);
    control.enter(2, 2, false);
    control.leave(1);
    EXPECT_TRUE(control.controls(2));
    control.enter(3, 1, false);
    EXPECT_TRUE(control.controls(3));
    EXPECT_FALSE(control.controls(2));
}

TEST(SceneControl, WhoeverKnowsTheTokenHasIt) {
    SceneControl control(ControlRule::token);
    control.enter(1, 1, false);
    control.enter(2, 2, true);
    control.enter(3, 3, true);
    EXPECT_FALSE(control.controls(1));
    EXPECT_TRUE(control.controls(2));
    EXPECT_TRUE(control.controls(3));
    control.leave(2);
    EXPECT_FALSE(control.controls(2));
}

TEST(SceneControl, AllHaveItWhereItIsShared) {
    SceneControl control(ControlRule::everybody);
    control.enter(1, 1, false);
    control.enter(2, 2, false);
    EXPECT_TRUE(control.controls(1));
    EXPECT_TRUE(control.controls(2));
}

} // namespace
} // namespace framelet
