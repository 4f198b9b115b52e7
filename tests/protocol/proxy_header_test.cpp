#include "protocol/stream/proxy_header.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

using Header = std::vector<std::uint8_t>;

/// A header with this command, these addresses' kind, and so many bytes of them.
Header header_of(std::uint8_t command, std::uint8_t kind, Header const& rest) {
    Header header{0x0d, 0x0a, 0x0d, 0x0a, 0x00, 0x0d, 0x0a, 0x51, 0x55, 0x49, 0x54, 0x0a, command, kind};
    header.push_back(static_cast<std::uint8_t>(rest.size() >> 8));
    header.push_back(static_cast<std::uint8_t>(rest.size()));
    header.insert(header.end(), rest.begin(), rest.end());
    return header;
}

Header const over_ipv4{203, 0, 113, 9, 10, 0, 0, 1, 0x12, 0x34, 0x1b, 0x9e};

TEST(ProxyHeader, SaysWhoConnects) {
    ProxiedSource const v4 = parse_proxy_header(header_of(0x21, 0x11, over_ipv4));
    ASSERT_TRUE(v4.is_valid && v4.address);
    EXPECT_EQ(v4.address->to_string(), "203.0.113.9");
    Header both(36);
    both[0] = 0x20, both[1] = 0x01, both[2] = 0x0d, both[3] = 0xb8, both[15] = 7;
    ProxiedSource const v6 = parse_proxy_header(header_of(0x21, 0x21, both));
    ASSERT_TRUE(v6.is_valid && v6.address);
    EXPECT_EQ(v6.address->to_string(), "2001:db8::7");
}

TEST(ProxyHeader, WhatComesAfterTheAddressesIsPassedOver) {
    Header more = over_ipv4;
    more.insert(more.end(), {0x04, 0x00, 0x02, 0xff, 0xff}); // a field, as HAProxy adds them
    EXPECT_EQ(parse_proxy_header(header_of(0x21, 0x11, more)).address->to_string(), "203.0.113.9");
}

TEST(ProxyHeader, AProxyMayConnectForItselfOrForNobodyItKnows) {
    for (Header const& header : {header_of(0x20, 0x00, {}), header_of(0x20, 0x11, over_ipv4), header_of(0x21, 0x00, {}),
                                 header_of(0x21, 0x31, Header(216))}) {
        ProxiedSource const source = parse_proxy_header(header);
        EXPECT_TRUE(source.is_valid);
        EXPECT_FALSE(source.address);
    }
}

TEST(ProxyHeader, OtherBytesAreNone) {
    Header const whole = header_of(0x21, 0x11, over_ipv4);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_FALSE(parse_proxy_header(std::span(whole).first(size)).is_valid) << size;
    }
    EXPECT_FALSE(parse_proxy_header(header_of(0x21, 0x21, over_ipv4)).is_valid) << "too few bytes for IPv6";
    EXPECT_FALSE(rest_of_proxy_header(header_of(0x11, 0x11, over_ipv4))) << "another version";
    EXPECT_FALSE(rest_of_proxy_header(header_of(0x22, 0x11, over_ipv4))) << "another command";
    EXPECT_FALSE(rest_of_proxy_header(header_of(0x21, 0x11, Header(most_of_proxy_header + 1)))) << "too long";
    std::string const first_version = "PROXY TCP4 203.0.113.9 10.0.0.1 4660 7070\r\n";
    EXPECT_FALSE(rest_of_proxy_header(Header(first_version.begin(), first_version.end())));
}

TEST(ProxyHeader, AnyBytesAreReadWithinTheirBounds) {
    std::mt19937 random(3);
    Header const whole = header_of(0x21, 0x11, over_ipv4);
    for (int i = 0; i < 1'000'000; ++i) {
        Header header = whole;
        header.resize(random() % 60, static_cast<std::uint8_t>(random()));
        for (auto changes = random() % 3; changes > 0 && !header.empty(); --changes) {
            header[random() % header.size()] = static_cast<std::uint8_t>(random());
        }
        ProxiedSource const source = parse_proxy_header(header);
        ASSERT_TRUE(source.is_valid || !source.address);
        ASSERT_TRUE(!source.is_valid || *rest_of_proxy_header(header) == header.size() - proxy_header_start);
    }
}

} // namespace
} // namespace framelet
