#include "common/one_line.h"

#include <random>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(OneLine, OneLineOfUtf8) {
    for (char const* good : {"", "plain ~", "\u00e9\u4e16\U0001f600", "\u00a0", "\uffff", "\U0010ffff"}) {
        EXPECT_TRUE(is_one_line(good)) << good;
        EXPECT_EQ(to_one_line(good, 100), good);
    }
    // Texts that are refused: controls (C0, DEL, C1), stray and missing continuations, overlong forms, surrogates,
    // beyond U+10FFFF.
    for (char const* bad : {"\n", "\t", "\x7f", "\xc2\x80", "\xc2\x9f", "\x80", "\xc3", "\xe4\xb8", "\xc0\x80",
                            "\xc1\xbf", "\xe0\x80\x80", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf", "\xed\xa0\x80",
                            "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff"}) {
        EXPECT_FALSE(is_one_line(bad)) << bad;
        EXPECT_TRUE(is_one_line(to_one_line(bad, 100)));
    }
}

TEST(OneLine, IsCutBetweenCharacters) {
    EXPECT_EQ(to_one_line("a\u4e16\u4e16", 6), "a\u4e16");
    EXPECT_EQ(to_one_line("a\u4e16\u4e16", 7), "a\u4e16\u4e16");
    EXPECT_EQ(to_one_line("abc", 0), "");
}

TEST(OneLine, AnyBytesBecomeText) {
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        std::string text(random() % 12, '\0');
        for (char& c : text) {
            c = static_cast<char>(random());
        }
        std::string const line = to_one_line(text, 8);
        EXPECT_TRUE(is_one_line(line));
        EXPECT_LE(line.size(), 8u);
        if (is_one_line(text) && text.size() <= 8) {
            EXPECT_EQ(line, text);
        }
    }
}

} // namespace
} // namespace framelet
