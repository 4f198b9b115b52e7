#include "server/sampling/plan/render_rate.h"

#include <cmath>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(RenderRate, TakesTheFirstMeasurementAndFollowsAChange) {
    RenderRate rate = update_render_rate({}, 1000, 0.001);
    EXPECT_DOUBLE_EQ(rate.samples_per_second, 1e6);
    for (int i = 0; i < 100; ++i) {
        rate = update_render_rate(rate, 2e4, 0.02); // steady
    }
    EXPECT_NEAR(rate.samples_per_second, 1e6, 1);
    for (int i = 0; i < 50; ++i) {
        rate = update_render_rate(rate, 4e3, 0.02); // five times slower, for one second
    }
    EXPECT_NEAR(rate.samples_per_second, 2e5, 2e4);
}

TEST(RenderRate, IgnoresWhatIsNoMeasurement) {
    RenderRate const rate{5};
    EXPECT_EQ(update_render_rate(rate, 0, 1).samples_per_second, 5);
    EXPECT_EQ(update_render_rate(rate, 1, 0).samples_per_second, 5);
    EXPECT_EQ(update_render_rate(rate, 1, NAN).samples_per_second, 5);
}

} // namespace
} // namespace framelet
