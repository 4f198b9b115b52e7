#include "client/processes/end_signals.h"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

namespace framelet {
namespace {

/// Ends the process: 3 where it has been told to end.
void end() {
    std::_Exit(is_told_to_end() ? 3 : 0);
}

TEST(EndSignals, TheFirstIsNoted) {
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        auto const is_noted = [number] {
            std::signal(SIGHUP, SIG_DFL); // also where the tests run under nohup
            note_end_signals();
            std::raise(number);
            end();
        };
        EXPECT_EXIT(is_noted(), testing::ExitedWithCode(3), "") << number;
    }
    EXPECT_FALSE(is_told_to_end());
}

TEST(EndSignals, ASecondEndsTheProgramUnlessTheTerminalIsGone) {
    auto const twice = [](int number) {
        std::signal(SIGHUP, SIG_DFL);
        note_end_signals();
        std::raise(number);
        std::raise(number);
        end();
    };
    EXPECT_EXIT(twice(SIGINT), testing::KilledBySignal(SIGINT), "");
    EXPECT_EXIT(twice(SIGTERM), testing::KilledBySignal(SIGTERM), "");
    EXPECT_EXIT(twice(SIGHUP), testing::ExitedWithCode(3), "");
}

TEST(EndSignals, ATerminalThatIsGoneMeansNothingUnderNohup) {
    auto const ignored = [] {
        std::signal(SIGHUP, SIG_IGN);
        note_end_signals();
        std::raise(SIGHUP);
        end();
    };
    EXPECT_EXIT(ignored(), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace framelet
