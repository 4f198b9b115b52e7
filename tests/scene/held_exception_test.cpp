// Tests what keeps exceptions from a library that must not see them.
#include "server/scene/reading/held_exception.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(HeldException, ThrowsTheFirstOneWhenItIsAskedTo) {
    HeldException held;
    int calls = 0;
    EXPECT_TRUE(held.call([&] { ++calls; }));
    EXPECT_NO_THROW(held.rethrow());
    EXPECT_FALSE(held.call([] { throw 7; }));
    EXPECT_FALSE(held.call([&] { ++calls; }));
    EXPECT_EQ(calls, 1) << "nothing is called any more";
    EXPECT_THROW(held.rethrow(), int);
}

} // namespace
} // namespace framelet
