#include "client/window/overlay/lacks.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "client/window/overlay/help_text.h"
#include "client/window/overlay/overlay_text.h"

namespace framelet {
namespace {

TEST(Lacks, TheClockIsSetWhereSomethingMovesAndNobodyElseSetsIt) {
    EXPECT_EQ(clock_lacks(false, true, true), "");
    EXPECT_EQ(clock_lacks(false, true, false), watching_text);
    EXPECT_EQ(clock_lacks(false, false, true), "nothing moves in this scene");
    EXPECT_EQ(clock_lacks(true, true, true), "the server is gone: its clock cannot be set");
    EXPECT_EQ(clock_lacks(true, false, false), clock_lacks(true, true, true)) << "what is worst is said";
}

TEST(Lacks, WhatIsThereIsNotLacking) {
    EXPECT_EQ(scene_cameras_lack(1), "");
    EXPECT_NE(scene_cameras_lack(0), "");
    EXPECT_EQ(smoothing_lacks(true, true), "");
    EXPECT_EQ(smoothing_lacks(false, true), clock_lacks(false, false, true));
    EXPECT_NE(smoothing_lacks(true, false).find("F4"), std::string::npos);
    EXPECT_EQ(confidence_lacks(true), "");
    EXPECT_NE(confidence_lacks(false).find("F4"), std::string::npos);
    EXPECT_EQ(picture_lacks(true), "");
    EXPECT_NE(picture_lacks(false), "");
    Camera camera;
    EXPECT_EQ(camera_file_lacks(camera), "");
    camera.projection = Projection::orthographic;
    EXPECT_NE(camera_file_lacks(camera), "");
}

TEST(Lacks, TheHelpSaysWhyTheClocksKeysDoNothing) {
    auto const says = [](TextRows const& rows, std::string const& text) {
        return std::ranges::any_of(rows, [&](auto const& row) { return row.second == text; });
    };
    for (std::string const& reason : {clock_lacks(false, true, false), clock_lacks(false, false, true)}) {
        EXPECT_FALSE(says(help_rows(""), reason));
        EXPECT_TRUE(says(help_rows(reason), reason));
        EXPECT_LT(help_rows(reason).size(), help_rows("").size());
    }
}

} // namespace
} // namespace framelet
