#include "protocol/codec/batch_codec.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <zstd.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "random_shape.h"

namespace framelet {
namespace {

using Sample = std::uint8_t (*)(std::mt19937& random, int channel, int x, int y);

std::uint8_t noise(std::mt19937& random, int, int, int) {
    return static_cast<std::uint8_t>(random());
}
std::uint8_t smooth(std::mt19937&, int channel, int x, int y) {
    return static_cast<std::uint8_t>(128 + 100 * std::sin(0.03 * x + channel) * std::cos(0.02 * y));
}
std::uint8_t constant(std::mt19937&, int channel, int, int) {
    return static_cast<std::uint8_t>(40 + channel);
}

/// A batch of the first `count` tiles of 128 columns, one sample a pixel.
Batch make_batch(std::size_t count, Sample sample) {
    std::mt19937 random(static_cast<std::uint32_t>(count));
    Batch batch;
    batch.number = 7;
    batch.view.number = 3;
    batch.view.viewport = {2048, 4096};
    batch.scene_time = 1.5;
    batch.shown_from = 1.25;
    batch.outdates = true;
    batch.framelets.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        DisplayFramelet& framelet = batch.framelets[i];
        auto const column = static_cast<std::uint32_t>(i % 128);
        auto const row = static_cast<std::uint32_t>(i / 128);
        framelet.tile = make_tile(8, column, row);
        for (std::uint32_t k = 0; k < framelet_samples; ++k) {
            auto const x = static_cast<int>(column * 16 + morton_x(k));
            auto const y = static_cast<int>(row * 16 + morton_y(k));
            framelet.red[k] = sample(random, 0, x, y);
            framelet.green[k] = sample(random, 1, x, y);
            framelet.blue[k] = sample(random, 2, x, y);
        }
    }
    return batch;
}

/// The example of PROTOCOL.md: red = x + 16 y, green = 10, blue = 0 in the first framelet, 255 in the second.
Batch documented_batch() {
    Batch batch = make_batch(2, constant);
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::uint32_t k = 0; k < framelet_samples; ++k) {
            batch.framelets[i].red[k] = static_cast<std::uint8_t>(morton_x(k) + 16 * morton_y(k));
            batch.framelets[i].green[k] = 10;
            batch.framelets[i].blue[k] = i == 0 ? 0 : 255;
        }
    }
    return batch;
}

std::size_t length_at(Bytes const& payload, std::size_t group) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        length |= std::to_integer<std::size_t>(payload[group * 4 + i]) << (8 * i);
    }
    return length;
}

Bytes compress(std::vector<std::uint8_t> const& content) {
    Bytes frame(ZSTD_compressBound(content.size()));
    frame.resize(ZSTD_compress(frame.data(), frame.size(), content.data(), content.size(), 1));
    return frame;
}

void expect_refused(EncodedBatch const& encoded, std::string const& word) {
    try {
        BatchCodec().decode(encoded);
        ADD_FAILURE() << "accepted, should name " << word;
    } catch (ProtocolError const& error) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

TEST(BatchCodec, RoundTrip) {
    BatchCodec codec;
    for (Sample const sample : {noise, smooth, constant}) {
        for (std::size_t const count : {0u, 1u, 2u, 127u, 128u, 129u, 300u, 1000u}) {
            Batch const batch = make_batch(count, sample);
            EncodedBatch const encoded = codec.encode(batch);
            EXPECT_EQ(encoded.number, batch.number);
            EXPECT_EQ(encoded.moment, (BatchMoment{batch.view, batch.scene_time, batch.shown_from, batch.outdates}));
            EXPECT_TRUE(codec.decode(encoded) == batch) << count;
        }
    }
}

TEST(BatchCodec, MemoryOfAnotherBatchLeavesNoTrace) {
    BatchCodec codec;
    RandomShapes random(1);
    Batch reused;
    for (int i = 0; i < 60; ++i) {
        Batch batch = make_batch(random.integer(0, 300), i % 2 == 0 ? noise : smooth);
        bool const deforms = random.integer(0, 1) == 1;
        if (random.integer(0, 3) > 0) {
            for (std::size_t k = 0; k < batch.framelets.size(); ++k) {
                batch.shapes.push_back(random.shape(deforms));
            }
        }
        if (random.integer(0, 1) == 1) {
            batch.qp.assign(batch.framelets.size(), 12);
        }
        EncodedBatch const encoded = codec.encode(batch);
        codec.decode(encoded, nullptr, reused);
        EXPECT_TRUE(reused == codec.decode(encoded)) << i;
    }
}

TEST(BatchCodec, LargestBatch) {
    Batch const batch = make_batch(max_batch_framelets, noise);
    BatchCodec codec;
    EncodedBatch const encoded = codec.encode(batch);
    EXPECT_LT(encode_message(encoded).size(), max_message_bytes);
    EXPECT_TRUE(codec.decode(encoded) == batch);
}

TEST(BatchCodec, ConstantCostsNearlyNothing) {
    EXPECT_LT(BatchCodec().encode(make_batch(1280, constant)).payload.size(), 1280u * 8);
}

TEST(BatchCodec, SameBytesWhateverTheThreadsAndTheHistory) {
    Batch const batch = make_batch(1000, smooth);
    BatchCodec codec;
    Bytes const first = codec.encode(batch).payload;
    codec.encode(make_batch(700, noise));
    EXPECT_EQ(codec.encode(batch).payload, first);
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(codec.encode(batch).payload, first);
    EXPECT_EQ(BatchCodec().encode(batch).payload, first);
}

TEST(BatchCodec, GoldenLayoutBeforeCompression) {
    Batch const batch = documented_batch();
    Bytes const payload = BatchCodec().encode(batch).payload;
    std::vector<std::uint8_t> content(3 * 512 + 1);
    ASSERT_EQ(ZSTD_decompress(content.data(), content.size(), payload.data(), payload.size()), 3u * 512);

    std::vector<std::uint8_t> golden;
    for (int framelet = 0; framelet < 2; ++framelet) { // red: first row 00 01 01 .., others 10 01 01 ..
        for (int y = 0; y < 16; ++y) {
            golden.push_back(y == 0 ? 0x00 : 0x10);
            golden.insert(golden.end(), 15, 0x01);
        }
    }
    for (int framelet = 0; framelet < 2; ++framelet) { // green: 0a 00 00 ..
        golden.push_back(0x0a);
        golden.insert(golden.end(), 255, 0x00);
    }
    golden.insert(golden.end(), 256, 0x00); // blue of the first
    golden.push_back(0xff); // blue of the second: ff 00 00 ..
    golden.insert(golden.end(), 255, 0x00);
    content.resize(golden.size());
    EXPECT_EQ(content, golden);
}

TEST(BatchCodec, GoldenPayload) {
    constexpr std::array<unsigned, 76> golden{
        0x28, 0xb5, 0x2f, 0xfd, 0x60, 0x00, 0x05, 0x15, 0x02, 0x00, 0x62, 0x44, 0x07, 0x0d, 0xd0, 0xa5,
        0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0x14, 0x00, 0x3f, 0xed, 0x89, 0x40, 0x60, 0xdb, 0xb6,
        0x6d, 0xdb, 0xb6, 0xcd, 0xb6, 0x6d, 0xdb, 0xb6, 0x6d, 0x9b, 0x23, 0x50, 0x02, 0x00, 0x7b, 0x6a,
        0x5f, 0xdd, 0x53, 0xb2, 0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0xb2,
        0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0xb2, 0x2c, 0xcb, 0x01};
    Batch const batch = documented_batch();
    EncodedBatch encoded{batch.number,
                         BatchMoment{batch.view, batch.scene_time, batch.shown_from, batch.outdates},
                         {},
                         Bytes(golden.size())};
    encoded.tiles = {batch.framelets[0].tile, batch.framelets[1].tile};
    std::transform(golden.begin(), golden.end(), encoded.payload.begin(),
                   [](unsigned b) { return static_cast<std::byte>(b); });
    EXPECT_TRUE(BatchCodec().decode(encoded) == batch);
}

TEST(BatchCodec, LayoutByTheBook) {
    // The layout is decoded here by its definition, written down a second time and as plainly as possible.
    Batch const batch = make_batch(130, noise);
    Bytes const payload = BatchCodec().encode(batch).payload;
    std::size_t offset = 4;
    std::size_t first = 0;
    for (std::size_t group = 0; group < 2; ++group) {
        std::size_t const count = group == 0 ? 128 : 2;
        std::size_t const length = group == 0 ? length_at(payload, 0) : payload.size() - offset;
        std::vector<std::uint8_t> content(count * 768);
        ASSERT_EQ(ZSTD_decompress(content.data(), content.size(), payload.data() + offset, length), content.size());
        for (std::size_t channel = 0; channel < 3; ++channel) {
            for (std::size_t i = 0; i < count; ++i) {
                DisplayFramelet const& framelet = batch.framelets[first + i];
                auto const& plane = channel == 0 ? framelet.red : channel == 1 ? framelet.green : framelet.blue;
                for (std::uint32_t y = 0; y < 16; ++y) {
                    for (std::uint32_t x = 0; x < 16; ++x) {
                        int const before = x > 0   ? plane[morton_index(x - 1, y)]
                                           : y > 0 ? plane[morton_index(0, y - 1)]
                                                   : 0;
                        auto const expected = static_cast<std::uint8_t>(plane[morton_index(x, y)] - before);
                        ASSERT_EQ(content[(channel * count + i) * 256 + y * 16 + x], expected);
                    }
                }
            }
        }
        offset += length;
        first += count;
    }
    EXPECT_EQ(offset, payload.size());
}

TEST(BatchCodec, DecompressionIsBounded) {
    EncodedBatch encoded = BatchCodec().encode(make_batch(1, constant));
    // The payload is 64 MiB of zeros in some kilobytes, for a tile that takes 768 bytes.
    Bytes const bomb = compress(std::vector<std::uint8_t>(64u << 20));
    EXPECT_LT(bomb.size(), 10000u);
    encoded.payload = bomb;
    expect_refused(encoded, "does not hold");
    // The next payloads are frames whose contents together would be right, and one that hides more behind itself.
    Bytes frames = compress(std::vector<std::uint8_t>(768));
    Bytes const right = frames;
    encoded.payload = right;
    EXPECT_NO_THROW(BatchCodec().decode(encoded));
    frames.insert(frames.end(), right.begin(), right.end());
    encoded.payload = frames;
    expect_refused(encoded, "exactly one");
    encoded.payload = compress(std::vector<std::uint8_t>(767));
    expect_refused(encoded, "does not hold");
    encoded.payload = compress({});
    expect_refused(encoded, "does not hold");
}

TEST(BatchCodec, FrameOfUnknownContentSizeIsRefused) {
    std::vector<std::uint8_t> const content(768, 3);
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> const context(ZSTD_createCCtx(), ZSTD_freeCCtx);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_contentSizeFlag, 0);
    Bytes frame(ZSTD_compressBound(content.size()));
    frame.resize(ZSTD_compress2(context.get(), frame.data(), frame.size(), content.data(), content.size()));
    EncodedBatch encoded = BatchCodec().encode(make_batch(1, constant));
    encoded.payload = frame;
    expect_refused(encoded, "does not hold");
}

TEST(BatchCodec, SkippableAndOldFramesAreRefused) {
    EncodedBatch encoded = BatchCodec().encode(make_batch(1, constant));
    Bytes skippable(8 + 768);
    constexpr std::array<unsigned, 8> header{0x50, 0x2a, 0x4d, 0x18, 0x00, 0x03, 0x00, 0x00};
    std::transform(header.begin(), header.end(), skippable.begin(),
                   [](unsigned b) { return static_cast<std::byte>(b); });
    encoded.payload = skippable;
    expect_refused(encoded, "not a zstd frame");
    Bytes old = compress(std::vector<std::uint8_t>(768));
    old[0] = std::byte{0x27}; // zstd 0.7
    encoded.payload = old;
    expect_refused(encoded, "not a zstd frame");
}

TEST(BatchCodec, LengthsThatDoNotFitAreRefused) {
    EncodedBatch const good = BatchCodec().encode(make_batch(200, smooth));
    EncodedBatch bad = good;
    bad.payload.pop_back();
    expect_refused(bad, "exactly one");
    bad = good;
    bad.payload.push_back({});
    expect_refused(bad, "exactly one");
    bad = good;
    bad.payload.resize(3);
    expect_refused(bad, "too short");
    bad = good;
    bad.payload[3] = std::byte{0xff};
    expect_refused(bad, "shorter");
    bad = good;
    bad.tiles.pop_back();
    expect_refused(bad, "does not hold");
    bad.tiles.clear();
    expect_refused(bad, "longer");
    bad = good;
    bad.tiles.resize(max_batch_framelets + 1);
    expect_refused(bad, "32768");
}

TEST(BatchCodec, TilesBeyondTheViewportAreRefused) {
    EncodedBatch const good = BatchCodec().encode(make_batch(1, constant));
    for (Tile const bad :
         {Tile{0}, Tile{1}, Tile{2}, make_tile(10, 0, 0), make_tile(7, 80, 0), make_tile(7, 0, 45), Tile{0xffffffff}}) {
        EncodedBatch encoded = good;
        encoded.moment->view.viewport = {1280, 720};
        encoded.tiles[0] = bad;
        expect_refused(encoded, "viewport");
    }
}

TEST(BatchCodec, AMomentIsStatedOnce) {
    BatchCodec codec;
    BatchMemory sent, received;
    Batch batch = make_batch(2, smooth);
    for (int i = 0; i < 4; ++i) {
        batch.scene_time = i / 2;
        batch.number = static_cast<std::uint64_t>(i) + 1;
        EncodedBatch const encoded = codec.encode(batch, &sent);
        EXPECT_EQ(encoded.moment.has_value(), i % 2 == 0);
        EXPECT_TRUE(codec.decode(encoded, &received) == batch) << i;
        if (!encoded.moment) {
            std::size_t const besides =
                encode_message(encoded).size() - encoded.payload.size() - batch.framelets.size();
            EXPECT_LE(besides, 100u) << "what a small batch over a narrow link is made small for";
            expect_refused(encoded, "moment");
            BatchMemory none;
            EXPECT_THROW(codec.decode(encoded, &none), ProtocolError);
        }
    }
}

TEST(BatchCodec, DamagedPayloadsAreRefusedOrDecoded) {
    BatchCodec codec;
    EncodedBatch const noisy = codec.encode(make_batch(3, noise));
    EncodedBatch const smoothed = codec.encode(make_batch(140, smooth));
    std::mt19937 random(1);
    std::size_t refused = 0;
    for (int i = 0; i < 6000; ++i) {
        EncodedBatch damaged = i % 2 == 0 ? noisy : smoothed;
        if (i % 3 == 0) {
            damaged.payload.resize(random() % damaged.payload.size());
            damaged.payload.shrink_to_fit();
        } else {
            for (auto flips = 1 + random() % 3; flips > 0; --flips) {
                std::size_t const end =
                    i % 5 == 0 ? std::min<std::size_t>(damaged.payload.size(), 40) : damaged.payload.size();
                damaged.payload[random() % end] ^= static_cast<std::byte>(1u << (random() % 8));
            }
        }
        try {
            EXPECT_EQ(codec.decode(damaged).framelets.size(), damaged.tiles.size());
        } catch (ProtocolError const&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 2000u);
    // Failures leave the codec usable.
    EXPECT_EQ(codec.encode(codec.decode(smoothed)), smoothed);
}

} // namespace
} // namespace framelet
