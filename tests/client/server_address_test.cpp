#include "protocol/connection/server_address.h"

#include <gtest/gtest.h>

#include "client/picture_size.h"
#include "common/error.h"

namespace framelet {
namespace {

TEST(ServerAddress, IsReadAsWritten) {
    EXPECT_EQ(parse_server_address("127.0.0.1:7070"), (ServerAddress{"127.0.0.1", 7070}));
    EXPECT_EQ(parse_server_address("render.example.org:1"), (ServerAddress{"render.example.org", 1}));
    EXPECT_EQ(parse_server_address("[::1]:65535"), (ServerAddress{"::1", 65535}));
    EXPECT_EQ(parse_server_address("[::1]:65535").text(), "[::1]:65535");
    EXPECT_EQ(parse_server_address("host:80").text(), "host:80");
    EXPECT_EQ(parse_server_address("localhost"), (ServerAddress{"localhost", 7070}));
    EXPECT_EQ(parse_server_address("[::1]"), (ServerAddress{"::1", 7070}));
    EXPECT_EQ(parse_address("localhost", 14158), (ServerAddress{"localhost", 14158}));
    EXPECT_EQ(parse_address("localhost:80", 14158), (ServerAddress{"localhost", 80}));
}

TEST(ServerAddress, IsTakenOutOfAUrl) {
    for (char const* const text : {"http://host:80", "https://host:80/", "http://me@host:80/scene?x=1#y", "host:80/a:b",
                                   " host:80\n", "me@host:80", "framelet://host:80", "HTTP://host:80"}) {
        EXPECT_EQ(parse_server_address(text), (ServerAddress{"host", 80})) << text;
    }
    EXPECT_EQ(parse_server_address("http://host/"), (ServerAddress{"host", default_port}));
    EXPECT_EQ(parse_server_address("https://[::1]:80/"), (ServerAddress{"::1", 80}));
    EXPECT_EQ(parse_server_address("::1"), (ServerAddress{"::1", 7070}));
    EXPECT_EQ(parse_server_address("fe80::1"), (ServerAddress{"fe80::1", 7070}));
}

TEST(ServerAddress, AUrlMaySayThatItIsEncrypted) {
    for (char const* const text : {"tls://host:80", "https://host:80/", " tls://host:80", "TLS://host:80"}) {
        EXPECT_TRUE(asks_for_tls(text)) << text;
        EXPECT_EQ(parse_server_address(text), (ServerAddress{"host", 80})) << text;
        EXPECT_EQ(with_tls(text, true), text);
        EXPECT_EQ(with_tls(text, false), "host:80");
    }
    for (char const* const text : {"host:80", "http://host:80", "tls", "https:80", "a.tls://host", ""}) {
        EXPECT_FALSE(asks_for_tls(text)) << text;
        EXPECT_EQ(with_tls(text, false), text);
    }
    EXPECT_EQ(with_tls("http://host:80/", true), "tls://host:80");
    ConnectionOptions options;
    options.server = {"::1", 80};
    EXPECT_EQ(options.server_name(), "[::1]:80");
    options.tls = true;
    EXPECT_EQ(options.server_name(), "tls://[::1]:80");
}

TEST(ServerAddress, AnythingElseIsRefused) {
    for (char const* const text : {"",           ":",       "host:",       ":7070",         "host:0",     "host:65536",
                                   "host:7070x", "host:-1", "a b:7070",    "::1:7070",      "::x",        "[::1",
                                   "[::1]:",     "[]",      "[::1]x:7070", "[]:7070",       "host:+5",    "http://",
                                   "me@",        "/host",   "ftp://host",  "ssh://host:80", "t ls://host"}) {
        EXPECT_THROW(parse_server_address(text), InputError) << text;
    }
}

TEST(PictureSize, IsReadOrRefused) {
    EXPECT_EQ(parse_size("1280x720"), (Viewport{1280, 720}));
    EXPECT_EQ(parse_size("1x16384"), (Viewport{1, 16384}));
    for (char const* const text : {"", "x", "12", "12x", "x12", "0x5", "5x0", "-3x5", "12x16385", "1x1x1", "1 x 1"}) {
        EXPECT_THROW(parse_size(text), InputError) << text;
    }
}

} // namespace
} // namespace framelet
