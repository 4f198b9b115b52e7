#include "protocol/codec/color/plane_codec.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/codec/batch_codec.h"
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

Bytes8 joined(PlaneParts const& parts) {
    Bytes8 bytes;
    for (auto const part : parts) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
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

/// PROTOCOL.md's example: a red of 16 x in the left half and of 128 elsewhere, green 100, blue 50, quality 8.
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

TEST(HaarTransform, AllNumbersOfPlacesAreAlike) {
    std::mt19937 random(1);
    constexpr std::size_t places = 7;
    std::array<std::int16_t, 4 * places> values, details, levels, again;
    std::array<std::int16_t, places> means;
    for (auto& value : values) {
        value = static_cast<std::int16_t>(random());
    }
    for (std::uint16_t const size : std::array<std::uint16_t, 4>{1, 2, 9, 1016}) {
        DetailStep const step(size);
        int const bits = haar_forward(values.data(), places, step, means.data(), details.data(), levels.data());
        EXPECT_EQ(quantise(details.data(), places, step, again.data()), bits);
        EXPECT_EQ(again, levels);
        int sum = 0;
        for (std::size_t i = 0; i < places; ++i) {
            std::array<std::int16_t, 4> of_details, of_levels;
            std::int16_t mean = 0;
            sum += haar_forward(&values[4 * i], 1, step, &mean, of_details.data(), of_levels.data());
            EXPECT_EQ(mean, means[i]);
            EXPECT_TRUE(std::equal(of_details.begin(), of_details.end(), &details[4 * i]));
            EXPECT_TRUE(std::equal(of_levels.begin(), of_levels.end(), &levels[4 * i]));
        }
        EXPECT_EQ(sum, bits);
        haar_inverse(means.data(), levels.data(), size, places, again.data());
        for (std::size_t i = 0; i < places; ++i) {
            std::array<std::int16_t, 4> single;
            haar_inverse(&means[i], &levels[4 * i], size, 1, single.data());
            EXPECT_TRUE(std::equal(single.begin(), single.end(), &again[4 * i]));
        }
    }
}

/// Against what the declaration says, for many steps that qualities make and every detail.
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

/// From hardly any level to hardly a zero, long runs over the ends of pieces, and the largest levels.
TEST(CoefficientTokens, PiecesAreReadAsTheyWereWritten) {
    constexpr std::array<std::size_t, 2> pieces{21, 64};
    constexpr std::size_t framelets = 40;
    std::mt19937 random(2);
    for (unsigned const density : {1u, 4u, 30u, 300u, 1000u}) {
        std::vector<std::int16_t> written;
        std::vector<std::uint8_t> tokens(framelets * 85 * 3), escapes(3 * tokens.size());
        TokenWriter writer(tokens.data());
        std::uint8_t* escape = escapes.data();
        for (std::size_t i = 0; i < framelets; ++i) {
            for (std::size_t const places : pieces) {
                std::vector<std::int16_t> fours(4 * places);
                for (std::size_t k = 0; k < fours.size(); ++k) {
                    int const level = random() % 10 == 0 ? static_cast<std::int16_t>(random()) : int(random() % 19) - 9;
                    fours[k] = static_cast<std::int16_t>(k % 4 != 0 && random() % 1000 < density ? level : 0);
                }
                escape = writer.write(fours.data(), places, escape);
                written.insert(written.end(), fours.begin(), fours.end());
            }
        }
        TokenReader reader(writer.tokens());
        ByteCursor cursor{escapes.data(), escape};
        std::vector<std::int16_t> read(written.size());
        std::int16_t* to = read.data();
        for (std::size_t i = 0; i < framelets; ++i) {
            for (std::size_t const places : pieces) {
                reader.read(to, places, cursor);
                to += 4 * places;
            }
        }
        EXPECT_EQ(read, written) << density << " of 1000";
        EXPECT_TRUE(reader.is_at_end());
        EXPECT_EQ(cursor.left(), 0u);
    }
}

TEST(PlaneCodec, ExactFrameletsAmongOthersStayExact) {
    auto const framelets = make_framelets(128);
    Bytes8 quality(framelets.size()), decoded_quality(framelets.size());
    for (std::size_t i = 0; i < quality.size(); ++i) {
        quality[i] = static_cast<std::uint8_t>(i % 2 == 0 ? exact_quality : i % (coarsest_quality + 1u));
    }
    PlaneCodec codec;
    Bytes8 const bytes = joined(codec.encode(framelets, quality));
    std::vector<DisplayFramelet> decoded(framelets.size());
    codec.decode(bytes, decoded, decoded_quality);
    EXPECT_EQ(decoded_quality, quality);
    for (std::size_t i = 0; i < quality.size(); i += 2) {
        EXPECT_EQ(decoded[i], framelets[i]) << i;
    }
}

TEST(PlaneCodec, ErrorFollowsTheQuality) {
    auto const framelets = make_framelets(3);
    PlaneCodec codec;
    for (std::uint8_t q = 1; q <= coarsest_quality; ++q) {
        Bytes8 quality(framelets.size(), q);
        std::vector<DisplayFramelet> decoded(framelets.size());
        codec.decode(joined(codec.encode(framelets, quality)), decoded, quality);
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            // An orthonormal detail is off by 0.66 steps at most, its square by 0.44; Y, Co, Cg count 3, 2, 3 times,
            // the step of Co is 1.25 times as long. Rounding of a sample adds at most a half.
            double const bound = 0.44 * q * q * (3 + 2 * 1.5625 + 3) / 3;
            EXPECT_LE(std::sqrt(mean_square_error(framelets[i], decoded[i])), std::sqrt(bound) + 1) << int{q};
        }
    }
}

TEST(PlaneCodec, UniformFrameletsCostEightBytesAndAreNearlyExact) {
    std::vector<DisplayFramelet> framelets(100);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        framelets[i].red.fill(static_cast<std::uint8_t>(2 * i));
        framelets[i].green.fill(static_cast<std::uint8_t>(255 - i));
        framelets[i].blue.fill(7);
    }
    Bytes8 quality(framelets.size(), 16);
    PlaneCodec codec;
    Bytes8 const bytes = joined(codec.encode(framelets, quality));
    EXPECT_EQ(bytes.size(), 20 + 8 * framelets.size());
    std::vector<DisplayFramelet> decoded(framelets.size());
    codec.decode(bytes, decoded, quality);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        EXPECT_LE(mean_square_error(framelets[i], decoded[i]), 4) << i; // half a step of a mean is half a level
    }
}

TEST(PlaneCodec, GoldenBytes) {
    // As PROTOCOL.md has it.
    Bytes8 const golden{0x08, 0x87, 0xa9, 0x44, 0x3a, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x0b, 0x00, 0x00,
                        0x00, 0x0b, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x22, 0x00, 0x00, 0x00, 0x15, 0x01,
                        0x01, 0x11, 0x00, 0x20, 0x50, 0x53, 0x23, 0x23, 0x23, 0xe3, 0x23, 0x23, 0x23, 0x00, 0x2d,
                        0x5d, 0x53, 0x23, 0x23, 0x23, 0xe3, 0x23, 0x23, 0x23, 0x01, 0x21, 0x21, 0x21, 0x21, 0x21,
                        0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0xf1, 0xf0, 0x51, 0x21, 0x21,
                        0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21, 0x21};
    Bytes8 quality{8};
    std::array const framelets{documented_framelet()};
    PlaneCodec codec;
    EXPECT_EQ(joined(codec.encode(framelets, quality)), golden);
    std::array<DisplayFramelet, 1> decoded;
    codec.decode(golden, decoded, quality);
    EXPECT_EQ(quality[0], 8);
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
    Bytes8 quality(framelets.size());
    for (std::size_t i = 0; i < quality.size(); ++i) {
        quality[i] = static_cast<std::uint8_t>(i);
    }
    PlaneCodec codec;
    Bytes8 const good = joined(codec.encode(framelets, quality));
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
            codec.decode(bad, decoded, quality);
        } catch (ProtocolError const&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000u);
    Bytes8 bad = good;
    bad[0] = coarsest_quality + 1;
    EXPECT_THROW(codec.decode(bad, decoded, quality), ProtocolError);
    bad = good;
    bad.push_back(0);
    EXPECT_THROW(codec.decode(bad, decoded, quality), ProtocolError);
}

TEST(BatchCodec, QualitiesAndEncodingTravel) {
    Batch batch;
    batch.number = 1;
    batch.view.viewport = {1024, 1024};
    batch.framelets = make_framelets(300);
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        batch.framelets[i].tile = make_tile(6, static_cast<std::uint32_t>(i % 64), static_cast<std::uint32_t>(i / 64));
        batch.quality.push_back(static_cast<std::uint8_t>(i % 5 == 0 ? 0 : 12));
    }
    BatchCodec codec;
    auto const received = std::get<EncodedBatch>(decode_message(encode_message(codec.encode(batch))));
    EXPECT_EQ(received.encoding, SampleEncoding::haar);
    Batch const decoded = codec.decode(received);
    EXPECT_EQ(decoded.quality, batch.quality);
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        EXPECT_EQ(decoded.framelets[i].tile, batch.framelets[i].tile);
        EXPECT_TRUE(i % 5 != 0 || decoded.framelets[i] == batch.framelets[i]) << i;
    }
    // Framelets of an exact batch do not fit the other encoding, nor the other way round.
    EncodedBatch other = received;
    other.encoding = SampleEncoding::exact;
    EXPECT_THROW(codec.decode(other), ProtocolError);
    batch.quality.clear();
    other = codec.encode(batch);
    other.encoding = SampleEncoding::haar;
    EXPECT_THROW(codec.decode(other), ProtocolError);
}

} // namespace
} // namespace framelet
