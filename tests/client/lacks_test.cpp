#include "client/viewer/lacks.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "client/viewer/commands.h"
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
    EXPECT_EQ(bookmark_lacks(2, 1), "");
    EXPECT_EQ(bookmark_lacks(2, 2), "there are only 2 bookmarks");
    EXPECT_EQ(bookmark_lacks(0, 0), "there are no bookmarks yet: add one (B)");
    EXPECT_EQ(removal_lacks(1, 0), "");
    EXPECT_EQ(removal_lacks(1, -1), "no bookmark has been gone to: Shift+1 goes to the first");
    EXPECT_EQ(smoothing_lacks(true, true), "");
    EXPECT_EQ(smoothing_lacks(false, true), clock_lacks(false, false, true));
    EXPECT_NE(smoothing_lacks(true, false).find("F4"), std::string::npos);
    EXPECT_EQ(confidence_lacks(true), "");
    EXPECT_NE(confidence_lacks(false).find("F4"), std::string::npos);
    EXPECT_EQ(picture_lacks(true), "");
    EXPECT_NE(picture_lacks(false), "");
    EXPECT_EQ(clipboard_lacks(" {\"position\": [0, 0, 0]"), "") << "what it lacks of a camera file is said by line";
    for (char const* const text : {"", " \n", "some words", "[1, 2]"}) {
        EXPECT_EQ(clipboard_lacks(text), "the clipboard holds no camera") << text;
    }
}

TEST(Lacks, TheHelpSaysWhyTheClocksKeysDoNothing) {
    auto const rows_with = [](std::string const& lacks) {
        TextRows out;
        for (HelpGroup const& group : help_groups(lacks)) {
            out.insert(out.end(), group.rows.begin(), group.rows.end());
        }
        return out;
    };
    auto const says = [](TextRows const& rows, std::string const& text) {
        return std::ranges::any_of(rows, [&](auto const& row) { return row.second == text; });
    };
    for (std::string const& reason : {clock_lacks(false, true, false), clock_lacks(false, false, true)}) {
        EXPECT_FALSE(says(rows_with(""), reason));
        EXPECT_TRUE(says(rows_with(reason), reason));
        EXPECT_LT(rows_with(reason).size(), rows_with("").size());
    }
}

} // namespace
} // namespace framelet
