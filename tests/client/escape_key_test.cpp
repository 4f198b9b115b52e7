#include "client/window/escape_key.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(EscapeKey, LeavesOneThingAtATimeAndTheProgramByTheSecondInASecond) {
    EscapeKey key;
    OpenThings open{true, true, true, true};
    EXPECT_EQ(key.press(open, 0.1), EscapeLeaves::mouse_look);
    open.mouse_look = false;
    EXPECT_EQ(key.press(open, 0.2), EscapeLeaves::menu);
    open.menu = false;
    EXPECT_EQ(key.press(open, 0.3), EscapeLeaves::help);
    open.help = false;
    EXPECT_EQ(key.press(open, 0.4), EscapeLeaves::full_screen);
    open.full_screen = false;
    EXPECT_EQ(key.press(open, 0.5), EscapeLeaves::nothing_yet) << "those before were for something else";
    EXPECT_EQ(key.press(open, 1.4), EscapeLeaves::program);
}

TEST(EscapeKey, WhatComesLaterBeginsAnew) {
    EscapeKey key;
    EXPECT_EQ(key.press({}, 0), EscapeLeaves::nothing_yet);
    EXPECT_EQ(key.press({}, 1.1), EscapeLeaves::nothing_yet);
    EXPECT_EQ(key.press({.menu = true}, 1.2), EscapeLeaves::menu);
    EXPECT_EQ(key.press({}, 1.3), EscapeLeaves::nothing_yet) << "the menu came between";
    EXPECT_EQ(key.press({}, 1.4), EscapeLeaves::program);
}

} // namespace
} // namespace framelet
