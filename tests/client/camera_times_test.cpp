#include "client/core/camera/camera_times.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

TEST(CameraTimes, EachIsAskedOfOnceAndOlderOnesNoLonger) {
    CameraTimes times;
    CameraTimes::Time const start{};
    for (std::uint64_t number = 1; number <= 3; ++number) {
        times.note_set(number, start + number * 1s);
        times.note_sent(number, start + number * 10s);
    }
    EXPECT_EQ(times.since_set(2, start + 5s), 3.0);
    EXPECT_EQ(times.since_set(2, start + 5s), std::nullopt);
    EXPECT_EQ(times.since_set(1, start + 5s), std::nullopt);
    EXPECT_EQ(times.since_sent(2, start + 21s), 1.0) << "which is another time";
    times.forget_sent();
    EXPECT_EQ(times.since_sent(3, start + 31s), std::nullopt);
    EXPECT_EQ(times.since_set(3, start + 5s), 2.0);
    EXPECT_EQ(times.since_set(4, start + 5s), std::nullopt) << "which was not set";
}

TEST(CameraTimes, OfManyTheOldestAreForgotten) {
    CameraTimes times;
    for (std::uint64_t number = 1; number <= CameraTimes::most_cameras + 1; ++number) {
        times.note_set(number, {});
    }
    EXPECT_EQ(times.since_set(1, {}), std::nullopt);
    EXPECT_EQ(times.since_set(2, {}), 0.0);
}

} // namespace
} // namespace framelet
