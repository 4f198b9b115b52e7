#include "protocol/messages/message.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "random_message.h"

namespace framelet {
namespace {

Bytes from_hex(std::string_view hex) {
    Bytes bytes;
    std::string digits;
    for (char const c : hex) {
        if (std::isxdigit(static_cast<unsigned char>(c)) != 0) {
            digits += c;
        }
    }
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
        bytes.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
    return bytes;
}

std::string to_hex(ByteView bytes) {
    std::string hex;
    for (std::byte const byte : bytes) {
        constexpr char const* digits = "0123456789abcdef";
        hex += digits[std::to_integer<unsigned>(byte) >> 4];
        hex += digits[std::to_integer<unsigned>(byte) & 15u];
    }
    return hex;
}

/// Decodes bytes of any kind: either a message that can be encoded again, or a ProtocolError. Anything else is a crash.
bool decodes(ByteView body) {
    try {
        Message const message = decode_message(body);
        EXPECT_TRUE(same(decode_message(encode_message(message)), message));
        return true;
    } catch (ProtocolError const& error) {
        std::string const reason = error.what();
        EXPECT_FALSE(reason.empty());
        EXPECT_EQ(reason.find('\n'), std::string::npos);
        return false;
    }
}

TEST(Message, RoundTrip) {
    for (std::uint64_t seed = 0; seed < 5000; ++seed) {
        Message const message = RandomMessages(seed).message();
        EXPECT_TRUE(same(decode_message(encode_message(message)), message)) << "seed " << seed;
    }
}

TEST(Message, DefaultsRoundTrip) {
    EXPECT_TRUE(same(decode_message(encode_message(Hello{})), Hello{}));
    EXPECT_TRUE(same(decode_message(encode_message(CameraUpdate{})), CameraUpdate{}));
    EXPECT_TRUE(same(decode_message(encode_message(Welcome{})), Welcome{}));
    EXPECT_TRUE(same(decode_message(encode_message(Status{})), Status{}));
}

TEST(Message, AppendsBehindWhatIsThere) {
    Bytes bytes(4, std::byte{7});
    append_message(Ack{1, 2, 3}, bytes);
    EXPECT_EQ(bytes[3], std::byte{7});
    // The body then starts at an address that is no multiple of eight.
    EXPECT_TRUE(same(decode_message(ByteView(bytes).subspan(4)), Ack{1, 2, 3}));
}

TEST(Message, GoldenHello) {
    // The example of PROTOCOL.md.
    Bytes const golden = from_hex("10000000 46524d4c 08000c00 07000800 08000000 00000001 0c000000 08000c00"
                                  "06000800 08000000 00000700 04000000 06000000 73656372 65740000");
    EXPECT_EQ(to_hex(encode_message(Hello{7, "secret"})), to_hex(golden));
    EXPECT_TRUE(same(decode_message(golden), Hello{7, "secret"}));
}

TEST(Message, GoldenHelloOfOneThatComesBack) {
    Hello const hello{6, {}, coding::all, {0x0102030405060708, 0x1112131415161718}, 9};
    Bytes const golden = from_hex("14000000 46524d4c 00000000 08000e00 07000800 08000000 00000001 14000000 00000e00"
                                  "28000600 08000c00 10002000 0e000000 00000600 20000000 4b000000 08070605 04030201"
                                  "18171615 14131211 09000000 00000000 00000000 00000000");
    EXPECT_EQ(to_hex(encode_message(hello)), to_hex(golden));
    EXPECT_TRUE(same(decode_message(golden), hello));
}

TEST(Message, GoldenAck) {
    Bytes const golden = from_hex("10000000 46524d4c 08000e00 07000800 08000000 00000005 10000000 00000a00 18000800"
                                  "10000400 0a000000 c4090000 08070605 04030201 40420f00 00000000");
    EXPECT_EQ(to_hex(encode_message(Ack{0x0102030405060708, 1000000, 2500})), to_hex(golden));
    EXPECT_TRUE(same(decode_message(golden), Ack{0x0102030405060708, 1000000, 2500}));
}

TEST(Message, EvictedNamesFrameletsByBatchAndTile) {
    Evicted const gone{{{7, Tile{5}}, {7, Tile{19}}, {9, Tile{1}}}};
    EXPECT_TRUE(same(decode_message(encode_message(gone)), gone));
    EXPECT_TRUE(same(decode_message(encode_message(Evicted{})), Evicted{}));
    EXPECT_THROW(encode_message(Evicted{{{1, Tile{0}}}}), UnsendableMessage);
    EXPECT_THROW(encode_message(Evicted{std::vector<SentTile>(max_evicted + 1, {1, Tile{5}})}), UnsendableMessage);
    EXPECT_LT(encode_message(Evicted{std::vector<SentTile>(max_evicted, {1, Tile{5}})}).size(),
              max_upstream_message_bytes);
}

TEST(Message, SettingsSayWhetherAnybodyLooks) {
    for (bool const paused : {false, true}) {
        ViewerSettings const settings{1, 0.5f, false, paused};
        EXPECT_TRUE(same(decode_message(encode_message(settings)), settings));
    }
    // These settings are as a viewer sends them that knows nothing of pausing.
    Bytes const golden =
        from_hex("10000000 46524d4c 08000e00 07000800 08000000 00000003 10000000 00000a00 10000800 0c000700"
                 " 0a000000 00000000 0000803f 0000003f");
    EXPECT_EQ(to_hex(encode_message(ViewerSettings{1, 0.5f, false})), to_hex(golden));
    EXPECT_TRUE(same(decode_message(golden), ViewerSettings{1, 0.5f, false, false}));
}

TEST(Message, TextIsMadeOneLine) {
    auto const failure = std::get<Failure>(decode_message(encode_message(Failure{"two\nlines \x1b[31m \xff"})));
    EXPECT_EQ(failure.text, "two?lines ?[31m ?");
    auto const cut = std::get<Failure>(decode_message(encode_message(Failure{std::string(5000, 'x')})));
    EXPECT_EQ(cut.text, std::string(4096, 'x'));
}

TEST(Message, WelcomeStaysWithinTheLimitOfTheHandshake) {
    for (std::size_t const length : {std::size_t{0}, std::size_t{1}, std::size_t{30}, std::size_t{1024}}) {
        Welcome welcome;
        welcome.server = welcome.scene_name = std::string(1024, 's');
        welcome.scene_bounds.include({0, 0, 0});
        welcome.cameras.resize(20);
        EXPECT_EQ(std::get<Welcome>(decode_message(encode_message(welcome))).cameras.size(), 20u);
        welcome.cameras.resize(5000);
        for (std::size_t i = 0; i < welcome.cameras.size(); ++i) {
            welcome.cameras[i].name.assign(length, 'n');
            welcome.cameras[i].camera.position.x = static_cast<float>(i);
        }
        Bytes const body = encode_message(welcome);
        EXPECT_LE(body.size(), max_upstream_message_bytes);
        auto const read = std::get<Welcome>(decode_message(body));
        ASSERT_GT(read.cameras.size(), 20u);
        EXPECT_EQ(read.cameras.back(), welcome.cameras[read.cameras.size() - 1]) << "the first ones are kept";
    }
}

TEST(Message, EveryTruncationIsRefusedOrValid) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Bytes const whole = encode_message(RandomMessages(seed).message());
        std::size_t const step = std::max<std::size_t>(1, whole.size() / 500);
        for (std::size_t size = 0; size < whole.size(); size += size < 300 ? 1 : step) {
            Bytes const part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)); // allocated by itself
            decodes(part);
        }
    }
    EXPECT_FALSE(decodes({}));
}

TEST(Message, FlippedBitsAreRefusedOrValid) {
    std::size_t accepted = 0;
    std::size_t refused = 0;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomMessages random(seed);
        Bytes bytes = encode_message(random.message());
        for (std::uint64_t flips = random.integer(1, 4); flips > 0; --flips) {
            // Bits are flipped mostly in front, where the tables are.
            std::size_t const end = random.coin() ? std::min<std::size_t>(bytes.size(), 128) : bytes.size();
            bytes[random.integer(0, end - 1)] ^= static_cast<std::byte>(1u << random.integer(0, 7));
        }
        ++(decodes(bytes) ? accepted : refused);
    }
    EXPECT_GT(accepted, 1000u);
    EXPECT_GT(refused, 1000u);
}

TEST(Message, RandomBytesAreRefused) {
    for (std::uint64_t seed = 0; seed < 5000; ++seed) {
        RandomMessages random(seed);
        Bytes bytes(random.integer(0, 300));
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(random.any64());
        }
        if (bytes.size() >= 8 && random.coin()) { // gets past the check of the identifier
            for (std::size_t i = 0; i < 4; ++i) {
                bytes[4 + i] = static_cast<std::byte>("FRML"[i]);
            }
        }
        decodes(bytes);
    }
}

} // namespace
} // namespace framelet
