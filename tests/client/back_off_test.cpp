#include "protocol/connection/back_off.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(BackOff, DoublesUpToItsLimitAndBeginsAnew) {
    BackOff back_off;
    for (double const seconds : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 8.0}) {
        EXPECT_EQ(back_off.next(0.5), seconds);
    }
    back_off.reset();
    EXPECT_EQ(back_off.next(0), 0.1875);
    EXPECT_LT(back_off.next(0.999), 0.625);
}

} // namespace
} // namespace framelet
