#include "client/core/session/asked_view.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using namespace std::chrono_literals;

constexpr Viewport small{32, 32}, large{64, 40};
AskedView::Time const start{};

TEST(AskedView, CountsUpAndWaitsUntilItIsSent) {
    AskedView asked;
    EXPECT_FALSE(asked.exists());
    EXPECT_FALSE(asked.is_unsent());
    asked.set({}, small, 2, start);
    asked.set({}, small, 3, start + 1s);
    EXPECT_TRUE(asked.exists());
    EXPECT_TRUE(asked.equals({}, small, 3));
    EXPECT_FALSE(asked.equals({}, small, 2));
    EXPECT_FALSE(asked.equals({}, large, 3));
    ASSERT_TRUE(asked.is_unsent());
    EXPECT_FALSE(asked.first_sent());
    CameraUpdate const sent = asked.send(start + 2s);
    EXPECT_EQ(sent.view.number, 2u);
    EXPECT_EQ(sent.scene_camera, 3);
    EXPECT_FALSE(asked.is_unsent());
    EXPECT_EQ(asked.first_sent(), start + 2s);
    EXPECT_EQ(asked.since_sent(2, start + 5s), 3);
    EXPECT_EQ(asked.since_set(2, start + 5s), 4);
}

TEST(AskedView, WantsWhatIsOfItsViewportSinceThatIsHeld) {
    AskedView asked;
    asked.set({}, small, -1, start);
    Batch batch;
    batch.view = asked.view();
    Camera other;
    other.position.x = 1;
    asked.set(other, small, -1, start);
    EXPECT_TRUE(asked.wants(batch));
    asked.set({}, large, -1, start);
    EXPECT_FALSE(asked.wants(batch));
    asked.set({}, small, -1, start);
    EXPECT_FALSE(asked.wants(batch)) << "it is of before the one between";
    EXPECT_EQ(asked.view().held_since, 4u);
}

TEST(AskedView, IsAskedOfEachSession) {
    AskedView asked;
    asked.begin_session();
    EXPECT_FALSE(asked.is_unsent()) << "nobody wants anything yet";
    asked.set({}, small, -1, start);
    asked.send(start);
    asked.begin_session();
    EXPECT_TRUE(asked.is_unsent());
    EXPECT_FALSE(asked.since_sent(1, start + 1s)) << "that was another session's";
    asked.send(start + 2s);
    EXPECT_EQ(asked.first_sent(), start) << "of all sessions";
}

} // namespace
} // namespace framelet
