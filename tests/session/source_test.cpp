#include "server/session/limits/source.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

std::string source_of_text(char const* address) {
    return source_of(boost::asio::ip::make_address(address));
}

TEST(Source, IsTheAddressOrTheNetworkOfOneMachine) {
    EXPECT_EQ(source_of_text("192.0.2.7"), "192.0.2.7");
    EXPECT_EQ(source_of_text("::ffff:192.0.2.7"), "192.0.2.7");
    EXPECT_EQ(source_of_text("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
    EXPECT_EQ(source_of_text("2001:db8:1:2::1"), source_of_text("2001:db8:1:2:ffff::"));
    EXPECT_NE(source_of_text("2001:db8:1:2::1"), source_of_text("2001:db8:1:3::1"));
}

} // namespace
} // namespace framelet
