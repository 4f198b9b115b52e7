#include "protocol/codec/color/plane_codec.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/codec/color/exact_planes.h"
#include "protocol/codec/color/haar_transform.h"
#include "protocol/messages/message_codec.h"

namespace framelet {
namespace {

using Bytes8 = std::vector<std::uint8_t>;

DisplayFramelet make_framelet(std::mt19937& random, int kind) {
    DisplayFramelet framelet;
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        auto const x = static_cast<int>(morton_x(k)), y = static_cast<int>(morton_y(k));
        auto const sample = [&](int channel) {
            int const smooth = 128 + static_cast<int>(90 * std::sin(0.2 * x + channel) * std::cos(0.15 * y));
            int const edge = x + y > 14 ? 230 : 20;
            int const noise = static_cast<int>(random() % 256);
            return static_cast<std::uint8_t>(kind == 0 ? smooth : kind == 1 ? edge : noise);
        };
        framelet.red[k] = sample(0);
        framelet.green[k] = sample(1);
        framelet.blue[k] = sample(2);
    }
    return framelet;
}

std::vector<DisplayFramelet> make_framelets(std::size_t count) {
    std::mt19937 random(static_cast<std::uint32_t>(count));
    std::vector<DisplayFramelet> framelets;
    for (std::size_t i = 0; i < count; ++i) {
        framelets.push_back(make_framelet(random, static_cast<int>(i % 3)));
    }
    return framelets;
}

/// Encodes framelets as the first group of a session.
Bytes8 encoded(std::span<DisplayFramelet const> framelets, Bytes8 const& qp) {
    PlaneModel model;
    PlaneCodec codec;
    auto const bytes = codec.encode(framelets, qp, model);
    return {bytes.begin(), bytes.end()};
}

void decode(Bytes8 const& bytes, std::span<DisplayFramelet> framelets, Bytes8& qp) {
    PlaneModel model;
    PlaneCodec::decode(bytes, framelets, qp, model);
}

double mean_square_error(DisplayFramelet const& a, DisplayFramelet const& b) {
    double sum = 0;
    for_each_plane([&](auto const plane) {
        for (std::size_t i = 0; i < framelet_samples; ++i) {
            double const difference = double((a.*plane)[i]) - double((b.*plane)[i]);
            sum += difference * difference;
        }
    });
    return sum / (3 * framelet_samples);
}

/// PROTOCOL.md's example: a red of 16 x in the left half and of 128 elsewhere, green 100, blue 50, QP 8.
DisplayFramelet documented_framelet() {
    DisplayFramelet framelet;
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        framelet.red[k] = static_cast<std::uint8_t>(std::min(16 * morton_x(k), 128u));
    }
    framelet.green.fill(100);
    framelet.blue.fill(50);
    return framelet;
}

TEST(HaarTransform, KnownValues) {
    std::array<std::int16_t, 4> const four{40, 20, 12, 8};
    std::array<std::int16_t, 4> details, levels;
    std::int16_t mean = 0;
    int const bits = haar_forward(four.data(), 1, DetailStep(3), &mean, details.data(), levels.data());
    EXPECT_EQ(mean, 20);
    EXPECT_EQ(details, (std::array<std::int16_t, 4>{20, 6, 10, 4}));
    EXPECT_EQ(levels, (std::array<std::int16_t, 4>{0, 2, 3, 1})); // 4 and 10 are a third above a level: down
    EXPECT_EQ(bits, 3 * bits_of_any + 6);
    details[0] = 99; // not read
    haar_inverse(&mean, details.data(), 1, 1, details.data());
    EXPECT_EQ(details, four);
    haar_inverse(&mean, levels.data(), 3, 1, levels.data());
    EXPECT_EQ(levels, (std::array<std::int16_t, 4>{20 + 6 + 9 + 3, 20 - 6 + 9 - 3, 20 + 6 - 9 - 3, 20 - 6 - 9 + 3}));
}

TEST(HaarTransform, AllNumbersOfBlocksAreAlike) {
    std::mt19937 random(1);
    constexpr std::size_t blocks = 7;
    std::array<std::int16_t, 4 * blocks> values, details, levels, again;
    std::array<std::int16_t, blocks> means;
    for (auto& value : values) {
        value = static_cast<std::int16_t>(random());
    }
    for (std::uint16_t const size : std::array<std::uint16_t, 4>{1, 2, 9, 1016}) {
        DetailStep const step(size);
        int const bits = haar_forward(values.data(), blocks, step, means.data(), details.data(), levels.data());
        EXPECT_EQ(quantise(details.data(), blocks, step, again.data()), bits);
        EXPECT_EQ(again, levels);
        int sum = 0;
        for (std::size_t i = 0; i < blocks; ++i) {
            std::array<std::int16_t, 4> of_details, of_levels;
            std::int16_t mean = 0;
            sum += haar_forward(&values[4 * i], 1, step, &mean, of_details.data(), of_levels.data());
            EXPECT_EQ(mean, means[i]);
            EXPECT_TRUE(std::equal(of_details.begin(), of_details.end(), &details[4 * i]));
            EXPECT_TRUE(std::equal(of_levels.begin(), of_levels.end(), &levels[4 * i]));
        }
        EXPECT_EQ(sum, bits);
        haar_inverse(means.data(), levels.data(), size, blocks, again.data());
        for (std::size_t i = 0; i < blocks; ++i) {
            std::array<std::int16_t, 4> single;
            haar_inverse(&means[i], &levels[4 * i], size, 1, single.data());
            EXPECT_TRUE(std::equal(single.begin(), single.end(), &again[4 * i]));
        }
    }
}

/// Checks levels against what the declaration says, for many steps that QPs make and every detail.
TEST(HaarTransform, LevelsAreTheNearestButForWhatIsNearerToZero) {
    std::vector<std::int16_t> details, levels;
    for (int value = -32768; value < 32768; value += 1) {
        if (details.size() % 4 == 0) {
            details.push_back(77); // a mean
        }
        details.push_back(static_cast<std::int16_t>(value));
    }
    details.resize((details.size() + 3) / 4 * 4);
    levels.resize(details.size());
    for (int base = 1; base <= 159; base += base < 19 ? 1 : 7) { // 159: the coarsest of all
        for (int const step : {base, 2 * base, 4 * base, 8 * base}) {
            for (std::size_t first = 0; first < details.size(); first += 256) { // an octave at a time
                std::size_t const some = std::min<std::size_t>(256, details.size() - first);
                int const bits =
                    quantise(&details[first], some / 4, DetailStep(static_cast<std::uint16_t>(step)), &levels[first]);
                int expected_bits = 0;
                for (std::size_t i = first; i < first + some; ++i) {
                    int const level = i % 4 == 0 ? 0 : int{levels[i]};
                    expected_bits += level == 0 ? 0 : bits_of_any + std::min(std::abs(level), int{most_bits_of_size});
                }
                EXPECT_EQ(bits, expected_bits);
            }
            for (std::size_t i = 0; i < details.size(); ++i) {
                int const size = std::abs(int{details[i]}) + step * 22 / 64;
                int const level = details[i] < 0 ? -int{levels[i]} : int{levels[i]};
                if (i % 4 == 0) {
                    ASSERT_EQ(levels[i], 0);
                } else if (details[i] == -32768 && step == 1) {
                    ASSERT_EQ(levels[i], details[i]); // has no counterpart
                } else {
                    ASSERT_GE(level, size / step) << details[i] << " / " << step;
                    ASSERT_LE(level, (size + size * step / 65536 + 1) / step) << details[i] << " / " << step;
                }
            }
        }
    }
}

TEST(PlaneCodec, ExactFrameletsAmongOthersStayExact) {
    auto const framelets = make_framelets(128);
    Bytes8 qp(framelets.size()), decoded_qp(framelets.size());
    for (std::size_t i = 0; i < qp.size(); ++i) {
        qp[i] = static_cast<std::uint8_t>(i % 2 == 0 ? lossless_qp : i % (coarsest_qp + 1u));
    }
    std::vector<DisplayFramelet> decoded(framelets.size());
    decode(encoded(framelets, qp), decoded, decoded_qp);
    EXPECT_EQ(decoded_qp, qp);
    for (std::size_t i = 0; i < qp.size(); i += 2) {
        EXPECT_EQ(decoded[i], framelets[i]) << i;
    }
}

TEST(PlaneCodec, ErrorFollowsTheQp) {
    auto const framelets = make_framelets(3);
    for (std::uint8_t q = 1; q <= coarsest_qp; ++q) {
        Bytes8 qp(framelets.size(), q);
        std::vector<DisplayFramelet> decoded(framelets.size());
        decode(encoded(framelets, qp), decoded, qp);
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            // An orthonormal detail is off by 0.66 steps at most, its square by 0.44; Y, Co, Cg count 3, 2, 3 times,
            // the step of Co is 1.25 times as long. Rounding of a sample adds at most a half.
            double const bound = 0.44 * q * q * (3 + 2 * 1.5625 + 3) / 3;
            EXPECT_LE(std::sqrt(mean_square_error(framelets[i], decoded[i])), std::sqrt(bound) + 1) << int{q};
        }
    }
}

TEST(PlaneCodec, UniformFrameletsCostFewBytesAndAreNearlyExact) {
    std::vector<DisplayFramelet> framelets(100);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        framelets[i].red.fill(static_cast<std::uint8_t>(2 * i));
        framelets[i].green.fill(static_cast<std::uint8_t>(255 - i));
        framelets[i].blue.fill(7);
    }
    Bytes8 qp(framelets.size(), 16);
    Bytes8 const bytes = encoded(framelets, qp);
    EXPECT_LT(bytes.size(), 4 * framelets.size()); // three means
    std::vector<DisplayFramelet> decoded(framelets.size());
    decode(bytes, decoded, qp);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        EXPECT_LE(mean_square_error(framelets[i], decoded[i]), 4) << i; // half a step of a mean is half a level
    }
}

TEST(PlaneCodec, GoldenBytes) {
    // The bytes of the example in PROTOCOL.md.
    Bytes8 const golden{0xf6, 0xff, 0x80, 0x0e, 0xe0, 0x00, 0x03, 0x50, 0x00, 0x03, 0xf0, 0x00, 0x01, 0xf0, 0x03, 0xf0,
                        0x07, 0x8e, 0x1d, 0xa2, 0x5b, 0x4f, 0x10, 0x01, 0xd5, 0xa5, 0xd2, 0x1d, 0xac, 0x77, 0x8e, 0xb3,
                        0xd0, 0x1d, 0x95, 0xc8, 0x9a, 0x1a, 0xaf, 0x05, 0x80, 0xdb, 0x31, 0x4b, 0x48, 0xa1, 0xf2, 0xd5,
                        0xad, 0x4c, 0xcd, 0x34, 0xda, 0x61, 0x5b, 0x7a, 0x7f, 0x99, 0x23, 0x79, 0x80};
    Bytes8 qp{8};
    std::array const framelets{documented_framelet()};
    EXPECT_EQ(encoded(framelets, qp), golden);
    std::array<DisplayFramelet, 1> decoded;
    decode(golden, decoded, qp);
    EXPECT_EQ(qp[0], 8);
    constexpr std::array<int, 16> red{3, 13, 36, 46, 67, 77, 100, 110, 128, 128, 128, 128, 128, 128, 128, 128};
    constexpr std::array<int, 16> blue{55, 45, 54, 44, 55, 45, 54, 44, 50, 50, 50, 50, 50, 50, 50, 50};
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        EXPECT_EQ(decoded[0].red[k], red[morton_x(k)]) << k;
        EXPECT_EQ(decoded[0].green[k], 100) << k;
        EXPECT_EQ(decoded[0].blue[k], blue[morton_x(k)]) << k;
    }
}

TEST(PlaneCodec, GarbageIsRefusedOrDecoded) {
    auto const framelets = make_framelets(30);
    Bytes8 qp(framelets.size());
    for (std::size_t i = 0; i < qp.size(); ++i) {
        qp[i] = static_cast<std::uint8_t>(i);
    }
    Bytes8 const good = encoded(framelets, qp);
    std::vector<DisplayFramelet> decoded(framelets.size());
    std::mt19937 random(1);
    std::size_t refused = 0;
    for (int i = 0; i < 3000; ++i) {
        Bytes8 bad = good;
        if (i % 3 == 0) {
            bad.resize(random() % bad.size());
            bad.shrink_to_fit();
        } else {
            for (int flips = 0; flips < 3; ++flips) {
                bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
            }
        }
        try {
            decode(bad, decoded, qp);
        } catch (ProtocolError const&) {
            ++refused;
        }
        for (std::uint8_t const q : qp) {
            ASSERT_LE(q, coarsest_qp);
        }
    }
    EXPECT_GT(refused, 1000u) << "numbers that are too large, or bytes that are left over";
    Bytes8 bad = good;
    bad.insert(bad.end(), 5, 0);
    EXPECT_THROW(decode(bad, decoded, qp), ProtocolError);
}

TEST(PlaneCodec, WhatIsLearntMakesTheNextGroupsSmaller) {
    auto const framelets = make_framelets(30);
    Bytes8 const qp(framelets.size(), 12);
    PlaneModel writing, reading;
    PlaneCodec codec;
    std::vector<DisplayFramelet> decoded(framelets.size()), first(framelets.size());
    Bytes8 read_qp(framelets.size());
    std::size_t bytes_before = 0;
    for (int i = 0; i < 3; ++i) {
        auto const bytes = codec.encode(framelets, qp, writing);
        EXPECT_TRUE(i == 0 || bytes.size() < bytes_before) << i;
        bytes_before = bytes.size();
        PlaneCodec::decode(bytes, decoded, read_qp, reading);
        first = i == 0 ? decoded : first;
        EXPECT_TRUE(decoded == first) << i;
    }
}

TEST(BatchCodec, QpsAndEncodingTravel) {
    Batch batch;
    batch.number = 1;
    batch.view.viewport = {1024, 1024};
    batch.framelets = make_framelets(300);
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        batch.framelets[i].tile = make_tile(6, static_cast<std::uint32_t>(i % 64), static_cast<std::uint32_t>(i / 64));
        batch.qp.push_back(static_cast<std::uint8_t>(i % 5 == 0 ? 0 : 12));
    }
    BatchCodec codec;
    auto const received = std::get<EncodedBatch>(decode_message(encode_message(codec.encode(batch))));
    EXPECT_EQ(received.encoding, SampleEncoding::haar);
    Batch const decoded = codec.decode(received);
    EXPECT_EQ(decoded.qp, batch.qp);
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        EXPECT_EQ(decoded.framelets[i].tile, batch.framelets[i].tile);
        EXPECT_TRUE(i % 5 != 0 || decoded.framelets[i] == batch.framelets[i]) << i;
    }
    // Framelets of an exact batch do not fit the other encoding, nor the other way round.
    EncodedBatch other = received;
    other.encoding = SampleEncoding::exact;
    EXPECT_THROW(codec.decode(other), ProtocolError);
    batch.qp.clear();
    other = codec.encode(batch);
    other.encoding = SampleEncoding::haar;
    EXPECT_THROW(codec.decode(other), ProtocolError);
}

} // namespace
} // namespace framelet
