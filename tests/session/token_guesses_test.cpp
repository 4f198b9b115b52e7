#include "server/session/limits/token_guesses.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

WallTime const start{1000s};

TEST(TokenGuesses, EachDoublesTheDelayUpToTheLongest) {
    TokenGuesses guesses;
    EXPECT_EQ(guesses.delay("one", start), 0s);
    for (auto const expected : {250ms, 500ms, 1000ms, 2000ms, 2000ms}) {
        guesses.note_wrong("one", start);
        EXPECT_EQ(guesses.delay("one", start), expected);
    }
    for (int i = 0; i < 100000; ++i) {
        guesses.note_wrong("one", start);
    }
    EXPECT_EQ(guesses.delay("one", start), TokenGuesses::longest_delay);
    EXPECT_EQ(guesses.delay("another", start), 0s);
}

TEST(TokenGuesses, AreForgotten) {
    TokenGuesses guesses;
    guesses.note_wrong("one", start);
    guesses.note_wrong("one", start + 50s);
    EXPECT_EQ(guesses.delay("one", start + 110s), 500ms);
    EXPECT_EQ(guesses.delay("one", start + 111s), 0s);
    guesses.note_wrong("one", start + 111s);
    EXPECT_EQ(guesses.delay("one", start + 111s), 250ms) << "it begins anew";
}

TEST(TokenGuesses, TakeBoundedMemory) {
    TokenGuesses guesses;
    for (std::size_t i = 0; i <= TokenGuesses::most_sources; ++i) {
        guesses.note_wrong(std::to_string(i), start + std::chrono::milliseconds(i));
    }
    WallTime const end = start + 10s;
    EXPECT_EQ(guesses.delay("0", end), 0s) << "the oldest is forgotten";
    EXPECT_EQ(guesses.delay("1", end), 250ms);
    EXPECT_EQ(guesses.delay(std::to_string(TokenGuesses::most_sources), end), 250ms);
}

} // namespace
} // namespace framelet
