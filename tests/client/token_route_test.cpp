#include "protocol/connection/token_route.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

using boost::asio::ip::make_address;

TEST(TokenRoute, GoesToOtherMachinesOnlyEncryptedOrAsTheUserWants) {
    ConnectionOptions plain;
    plain.token = "0123456789abcdef";
    ConnectionOptions tls = plain, insecure = plain, without;
    tls.tls = true;
    insecure.insecure = true;
    for (auto const* other :
         {"192.0.2.1", "10.0.0.1", "128.0.0.1", "0.0.0.0", "2001:db8::1", "fe80::1", "::", "::ffff:192.0.2.1", "::2"}) {
        EXPECT_FALSE(may_send_token(plain, make_address(other))) << other;
        EXPECT_TRUE(may_send_token(tls, make_address(other))) << other;
        EXPECT_TRUE(may_send_token(insecure, make_address(other))) << other;
        EXPECT_TRUE(may_send_token(without, make_address(other))) << other;
    }
    for (auto const* own : {"127.0.0.1", "127.8.9.10", "::1", "::ffff:127.0.0.1"}) {
        EXPECT_TRUE(may_send_token(plain, make_address(own))) << own;
    }
}

} // namespace
} // namespace framelet
