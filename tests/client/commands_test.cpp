#include "client/viewer/commands.h"

#include <set>
#include <tuple>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "client/core/drawn_over/drawn_over.h"

namespace framelet {
namespace {

TEST(Commands, NoKeyMeansTwoThings) {
    std::set<std::tuple<int, bool, bool, bool>> seen;
    for (KeyMeaning const& meaning : key_meanings()) {
        EXPECT_TRUE(seen.insert({meaning.key, meaning.with.shift, meaning.with.control, meaning.with.alt}).second)
            << key_names(meaning.command);
    }
}

TEST(Commands, EveryCommandHasAKeyAndAWordInTheHelp) {
    TextRows help;
    for (HelpGroup const& group : help_groups("")) {
        help.insert(help.end(), group.rows.begin(), group.rows.end());
    }
    for (int i = 0; i <= static_cast<int>(numbered(Command::bookmark, numbered_cameras - 1)); ++i) {
        auto const command = static_cast<Command>(i);
        std::string const keys = key_names(command);
        EXPECT_FALSE(keys.empty()) << i;
        if (command >= Command::scene_camera || command == Command::reconnect) {
            continue; // the numbered ones are one line; to connect is told where it can be done
        }
        EXPECT_NE(std::find(help.begin(), help.end(), std::pair(keys, help_text(command))), help.end()) << keys;
    }
}

TEST(Commands, TheHelpNamesEveryOverlay) {
    for (char const* const name : drawn_over_names) {
        EXPECT_NE(help_text(Command::next_overlay).find(name), std::string::npos) << name;
    }
}

TEST(Commands, WhatOneNeedsFirstComesFirst) {
    std::vector<HelpGroup> const groups = help_groups("");
    std::string first;
    for (auto const& [keys, text] : groups.front().rows) {
        first += keys + "\n";
    }
    for (std::string const& keys : {std::string("left drag"), std::string("wheel"), key_names(Command::fit_scene),
                                    key_names(Command::toggle_help), key_names(Command::quit)}) {
        EXPECT_NE(first.find(keys), std::string::npos) << keys;
    }
    for (HelpGroup const& group : groups) {
        EXPECT_FALSE(group.title.empty());
        EXPECT_FALSE(group.rows.empty()) << group.title;
    }
}

TEST(Commands, TwoColumnsAreAboutAsHigh) {
    auto const of = [](std::vector<std::size_t> const& sizes) {
        std::vector<HelpGroup> out;
        for (std::size_t const size : sizes) {
            out.push_back({"title", TextRows(size)});
        }
        return left_groups(out);
    };
    EXPECT_EQ(of({}), 0u);
    EXPECT_EQ(of({3}), 1u);
    EXPECT_EQ(of({3, 3}), 1u);
    EXPECT_EQ(of({3, 4}), 1u);
    EXPECT_EQ(of({1, 1, 5}), 2u);
    EXPECT_EQ(of({5, 1, 1, 1}), 1u);
}

TEST(Commands, ShiftCountsWhereItMeansSomething) {
    EXPECT_EQ(command_of_key(GLFW_KEY_B, {}, false), Command::add_bookmark);
    EXPECT_EQ(command_of_key(GLFW_KEY_B, {.shift = true}, false), Command::remove_bookmark);
    EXPECT_EQ(command_of_key(GLFW_KEY_EQUAL, {.shift = true}, false), Command::faster);
    EXPECT_EQ(command_of_key(GLFW_KEY_3, {}, false), numbered(Command::scene_camera, 2));
    EXPECT_EQ(command_of_key(GLFW_KEY_3, {.shift = true}, false), numbered(Command::bookmark, 2));
    EXPECT_EQ(command_of_key(GLFW_KEY_ENTER, {.alt = true}, false), Command::toggle_fullscreen);
    EXPECT_EQ(command_of_key(GLFW_KEY_R, {.control = true}, false), std::nullopt);
    EXPECT_EQ(command_of_key(GLFW_KEY_Q, {.control = true}, false), Command::quit);
    EXPECT_EQ(command_of_key(GLFW_KEY_Q, {}, false), std::nullopt) << "it flies";
    EXPECT_EQ(command_of_key(GLFW_KEY_F12 + 1, {}, false), std::nullopt);
}

TEST(Commands, OnlyStepsRepeat) {
    EXPECT_EQ(command_of_key(GLFW_KEY_PERIOD, {}, true), Command::step_forward);
    EXPECT_EQ(command_of_key(GLFW_KEY_F9, {}, true), std::nullopt);
}

TEST(Commands, NamesAreThoseOnTheKeyboard) {
    EXPECT_EQ(key_names(Command::toggle_statistics), "F2 or Tab");
    EXPECT_EQ(key_names(Command::toggle_fullscreen), "F11 or Alt+Enter");
    EXPECT_EQ(key_names(Command::faster), "+");
    EXPECT_EQ(key_names(Command::view_front), "Num 1");
    EXPECT_EQ(with_keys("record", Command::toggle_recording), "record (F9)");
    EXPECT_EQ(with_keys("close", Command::quit), "close (Ctrl+Q)");
}

} // namespace
} // namespace framelet
