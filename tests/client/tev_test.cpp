#include "client/tev/tev_sender.h"

#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include "client/tev/tev_packets.h"
#include "common/color.h"
#include "common/error.h"
#include "tests/client/fake_tev.h"

namespace framelet {
namespace {

using test::FakeTev;
using test::TevImage;

constexpr Viewport size{3, 2};

Picture grey(std::uint8_t value) {
    Picture out(size.width, size.height);
    std::fill(out.rgba.begin(), out.rgba.end(), value);
    return out;
}

TEST(TevPackets, AreTheBytesThatTevReads) {
    EXPECT_EQ(tev_create_image("ab", {2, 1}), std::string("\x1b\0\0\0"
                                                          "\x04\x01"
                                                          "ab\0"
                                                          "\x02\0\0\0"
                                                          "\x01\0\0\0"
                                                          "\x03\0\0\0"
                                                          "R\0G\0B\0",
                                                          27));
    Picture white(1, 1);
    std::fill(white.rgba.begin(), white.rgba.end(), 255);
    std::string const one("\0\0\x80\x3f", 4);
    std::string const head("\x5f\0\0\0"
                           "\x06\0"
                           "ab\0"
                           "\x03\0\0\0"
                           "R\0G\0B\0"
                           "\0\0\0\0"
                           "\0\0\0\0"
                           "\x01\0\0\0"
                           "\x01\0\0\0",
                           35);
    std::string const places("\0\0\0\0\0\0\0\0"
                             "\x01\0\0\0\0\0\0\0"
                             "\x02\0\0\0\0\0\0\0",
                             24);
    std::string const steps("\x03\0\0\0\0\0\0\0"
                            "\x03\0\0\0\0\0\0\0"
                            "\x03\0\0\0\0\0\0\0",
                            24);
    EXPECT_EQ(tev_update_image("ab", white), head + places + steps + one + one + one);
}

TEST(TevSender, SendsTheNewestPictureInLinearLight) {
    FakeTev tev;
    TevSender sender({"127.0.0.1", tev.port()}, "a name", size);
    for (std::uint8_t value = 0; value < 100; ++value) {
        Picture picture = grey(value);
        picture.rgba[4] = 255; // red of the second pixel
        sender.show({picture, true, true, 0});
    }
    sender.show({grey(200), false, true, 0}); // as before: nothing is to be sent
    sender.finish();
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while ((tev.image().values.empty() || tev.image().values[0] != linear_from_srgb_byte(99)) &&
           std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    TevImage const image = tev.image();
    EXPECT_EQ(image.complaint, "");
    EXPECT_EQ(image.name, "a name");
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
    ASSERT_EQ(image.values.size(), 18u);
    EXPECT_EQ(image.values[3], 1);
    EXPECT_EQ(image.values[17], linear_from_srgb_byte(99));
    EXPECT_LE(image.updates, 100);
}

TEST(TevSender, ATevThatGoesIsTheEndAndNoFailure) {
    FakeTev tev;
    TevSender sender({"127.0.0.1", tev.port()}, "a name", size);
    auto const deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (sender.end_reason().empty() && std::chrono::steady_clock::now() < deadline) {
        if (tev.image().updates > 0) {
            tev.end();
        }
        sender.show({grey(1), true, true, 0});
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_NE(sender.end_reason().find("has gone"), std::string::npos) << sender.end_reason();
    sender.finish();
}

TEST(TevSender, SaysThatNoTevIsThere) {
    try {
        TevSender sender({"127.0.0.1", 1}, "a name", size);
        FAIL();
    } catch (ConnectionError const& error) {
        EXPECT_NE(std::string(error.what()).find("cannot reach tev at 127.0.0.1:1"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace framelet
