#include "server/session/limits/farewells.h"

#include <gtest/gtest.h>

#include "fake_stream.h"

namespace framelet {
namespace {

TEST(Farewells, TheOldestIsClosedForOneTooMany) {
    Farewells farewells;
    std::vector<std::shared_ptr<FakeStream>> streams;
    for (std::size_t i = 0; i < Farewells::most; ++i) {
        farewells.add(std::make_shared<FakeStream>()); // this one is gone at once, and takes no place
        streams.push_back(std::make_shared<FakeStream>());
        farewells.add(streams.back());
    }
    auto const closed = [&] {
        return std::count_if(streams.begin(), streams.end(), [](auto const& stream) { return stream->is_closed; });
    };
    EXPECT_EQ(closed(), 0);
    auto const last = std::make_shared<FakeStream>();
    farewells.add(last);
    EXPECT_EQ(closed(), 1);
    EXPECT_TRUE(streams.front()->is_closed);
    EXPECT_FALSE(last->is_closed);
}

} // namespace
} // namespace framelet
