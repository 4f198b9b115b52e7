// Batches that are predicted from those before: both sides hold the same picture whatever was sent.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/codec/color/exact_planes.h"
#include "protocol/codec/color/plane_codec.h"
#include "protocol/messages/message_codec.h"

namespace framelet {
namespace {

/// Fills a framelet with waves, moved by `shift` pixels, and noise of so many levels.
void fill(DisplayFramelet& framelet, PixelRect rect, double shift, int noise, std::mt19937& random) {
    for (std::uint32_t k = 0; k < framelet_samples; ++k) {
        double const x = rect.left + (morton_x(k) + 0.5) * rect.width() / framelet_side + shift;
        double const y = rect.top + (morton_y(k) + 0.5) * rect.width() / framelet_side;
        double const value = 128 + 60 * std::sin(0.2 * x) + 60 * std::cos(0.23 * y + 0.1 * x) +
                             static_cast<double>(random() % static_cast<unsigned>(noise + 1));
        framelet.red[k] = static_cast<std::uint8_t>(std::min(value, 255.0));
        framelet.green[k] = static_cast<std::uint8_t>(value / 2);
        framelet.blue[k] = static_cast<std::uint8_t>(255 - framelet.red[k]);
    }
}

/// A batch of different tiles, of any depth where `depth` is negative.
Batch make_batch(std::mt19937& random, Viewport viewport, std::size_t count, double shift, int noise, int depth = -1) {
    ImagePlane const plane(viewport);
    Batch batch;
    batch.number = 1;
    batch.view.viewport = viewport;
    std::vector<Tile> tiles;
    for (std::uint32_t code = 1; code < 4u << (2 * plane.max_depth()); ++code) {
        if (plane.accepts({code}) && (depth < 0 || Tile{code}.depth() == depth)) {
            tiles.push_back({code});
        }
    }
    std::shuffle(tiles.begin(), tiles.end(), random);
    for (std::size_t i = 0; i < std::min(count, tiles.size()); ++i) {
        batch.framelets.push_back({tiles[i], {}, {}, {}});
        fill(batch.framelets.back(), plane.tile_rect(tiles[i]), shift, noise, random);
    }
    return batch;
}

std::size_t payload_bytes(BatchCodec& codec, BatchMemory& memory, Batch const& batch) {
    return codec.encode(batch, &memory).payload.size();
}

Batch with_qp(Batch batch, std::uint8_t qp) {
    batch.qp.assign(batch.framelets.size(), qp);
    return batch;
}

constexpr Viewport small_viewport{96, 64};

TEST(PredictedBatch, BothSidesHoldTheSameAfterAnySequence) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        std::mt19937 random(seed);
        BatchCodec encoder, decoder;
        BatchMemory sent, received;
        std::array const viewports{small_viewport, Viewport{17, 200}, Viewport{9, 5}};
        Viewport viewport = viewports[0];
        for (int i = 0; i < 120; ++i) {
            viewport = random() % 16 == 0 ? viewports[random() % viewports.size()] : viewport;
            Batch batch = make_batch(random, viewport, random() % 60, 0.3 * i, static_cast<int>(random() % 30));
            for (std::size_t f = 0; f < batch.framelets.size() && i % 5 != 0; ++f) {
                batch.qp.push_back(static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : random() % (coarsest_qp + 1)));
            }
            auto const arrived = std::get<EncodedBatch>(decode_message(encode_message(encoder.encode(batch, &sent))));
            Batch const decoded = decoder.decode(arrived, &received);
            ASSERT_TRUE(sent.picture == received.picture) << "seed " << seed << " batch " << i;
            ASSERT_EQ(decoded.qp, batch.qp);
            for (std::size_t f = 0; f < batch.framelets.size(); ++f) {
                bool const exact = batch.qp.empty() || batch.qp[f] == lossless_qp;
                ASSERT_TRUE(!exact || decoded.framelets[f] == batch.framelets[f]);
            }
        }
    }
}

/// Fills a framelet with anything that samples may be: noise, two extremes, one colour, the last framelet with a few
/// samples changed.
void fill_with_anything(DisplayFramelet& framelet, std::mt19937_64& random) {
    std::uint64_t const kind = random() % 4;
    for_each_plane([&](auto const plane) {
        auto& samples = framelet.*plane;
        for (std::size_t i = 0; i < samples.size() && kind < 2; i += sizeof(std::uint64_t)) {
            std::uint64_t const bits = random();
            for (std::size_t byte = 0; byte < sizeof bits; ++byte) {
                auto const noise = static_cast<std::uint8_t>(bits >> (8 * byte));
                samples[i + byte] = kind == 0 ? noise : noise < 40 ? std::uint8_t{0} : std::uint8_t{255};
            }
        }
        if (kind == 2) {
            samples.fill(static_cast<std::uint8_t>(random()));
        }
        samples[random() % samples.size()] = static_cast<std::uint8_t>(random());
    });
}

TEST(PredictedBatch, ReadersSeeWhatWritersSayWhateverTheSamplesAre) {
    constexpr std::size_t group = 64, groups = 600;
    std::mt19937_64 random(1);
    ImagePlane const plane(small_viewport);
    std::vector<DisplayFramelet> framelets;
    for (std::uint32_t code = 1; framelets.size() < group; code = code * 5 % 1024 + 1) {
        if (plane.accepts({code})) {
            framelets.push_back({{code}, {}, {}, {}});
        }
    }
    ReferencePicture held;
    held.show(small_viewport);
    held.prepare_search({});
    PlaneCodec codec;
    std::vector<DisplayFramelet> said = framelets, read = framelets;
    std::vector<std::uint8_t> qp(group), read_qp(group);
    PlaneModel writing, reading;
    for (std::size_t i = 0; i < groups; ++i) {
        for (std::size_t f = 0; f < group; ++f) {
            fill_with_anything(framelets[f], random);
            qp[f] = static_cast<std::uint8_t>(random() % 8 == 0 ? lossless_qp : random() % 128);
        }
        bool const is_predicted = i % 4 != 0;
        ReferencePicture const* const from = is_predicted ? &held : nullptr;
        PlaneCodec::decode(codec.encode(framelets, qp, writing, from, said), read, read_qp, reading, from);
        ASSERT_EQ(read_qp, qp);
        ASSERT_TRUE(!is_predicted || read == said) << "group " << i;
        for (std::size_t f = 0; f < group; ++f) {
            ASSERT_TRUE(qp[f] != lossless_qp || read[f] == framelets[f]) << "group " << i;
        }
        held.take(read);
    }
}

TEST(PredictedBatch, WhatIsHeldCostsNearlyNothing) {
    std::mt19937 random(1);
    int const depth = ImagePlane(small_viewport).pixel_depth();
    Batch const batch = with_qp(make_batch(random, small_viewport, 24, 0, 0, depth), 12);
    BatchCodec codec;
    BatchMemory memory;
    std::size_t const alone = payload_bytes(codec, memory, batch);
    std::size_t const again = payload_bytes(codec, memory, batch);
    EXPECT_LT(again * 10, alone);
    // The same batch is moved by three pixels: nearly all of it is found elsewhere.
    std::size_t const moved =
        payload_bytes(codec, memory, with_qp(make_batch(random, small_viewport, 24, 3, 0, depth), 12));
    EXPECT_LT(moved * 2, alone);
}

TEST(PredictedBatch, ErrorsDoNotAddUp) {
    std::mt19937 random(1);
    int const depth = ImagePlane(small_viewport).pixel_depth();
    BatchCodec codec;
    BatchMemory sent, received;
    constexpr std::uint8_t qp = 12;
    for (int i = 0; i < 60; ++i) {
        Batch const batch = with_qp(make_batch(random, small_viewport, 24, 0.15 * i, 0, depth), qp);
        Batch const decoded = codec.decode(codec.encode(batch, &sent), &received);
        double sum = 0;
        for (std::size_t f = 0; f < batch.framelets.size(); ++f) {
            for (std::size_t k = 0; k < framelet_samples; ++k) {
                double const error = double(batch.framelets[f].green[k]) - double(decoded.framelets[f].green[k]);
                sum += error * error;
            }
        }
        // An orthonormal detail is off by 0.66 steps at most; green is Y + Cg.
        double const mean = sum / static_cast<double>(batch.framelets.size() * framelet_samples);
        EXPECT_LE(std::sqrt(mean), 0.66 * qp * std::sqrt(2.0) + 1) << i;
    }
}

TEST(PredictedBatch, IsRefusedWithoutThePicture) {
    std::mt19937 random(1);
    BatchCodec codec;
    BatchMemory memory;
    EncodedBatch encoded = codec.encode(with_qp(make_batch(random, small_viewport, 5, 0, 0), 8), &memory);
    EXPECT_EQ(encoded.encoding, SampleEncoding::predicted);
    EXPECT_THROW(codec.decode(encoded), ProtocolError);
    BatchMemory other;
    EncodedBatch larger = encoded;
    larger.moment->view.viewport = {16384, 16384};
    EXPECT_THROW(codec.decode(larger, &other), ProtocolError);
    encoded.tiles[0] = {1u << 30}; // no tile of this viewport
    EXPECT_THROW(codec.decode(encoded, &other), ProtocolError);
}

TEST(PredictedBatch, ThereIsNoPictureWithoutLossNorOfLargeViewports) {
    std::mt19937 random(1);
    BatchCodec codec;
    BatchMemory memory;
    EXPECT_EQ(codec.encode(make_batch(random, small_viewport, 5, 0, 0), &memory).encoding, SampleEncoding::exact);
    EXPECT_FALSE(memory.picture.shows(small_viewport));
    Batch batch = with_qp(make_batch(random, small_viewport, 1, 0, 0), 8);
    batch.view.viewport = {16384, 16384};
    batch.framelets[0].tile = make_tile(10, 0, 0);
    EXPECT_EQ(codec.encode(batch, &memory).encoding, SampleEncoding::haar);
    EXPECT_FALSE(memory.picture.shows(batch.view.viewport));
}

TEST(PredictedBatch, DamagedGroupsAreRefusedOrDecoded) {
    std::mt19937 random(1);
    Batch batch = with_qp(make_batch(random, small_viewport, 40, 0, 3), 8);
    for (std::size_t i = 0; i < batch.qp.size(); i += 7) {
        batch.qp[i] = lossless_qp;
    }
    ReferencePicture held;
    held.show(small_viewport);
    held.prepare_search({});
    held.take(make_batch(random, small_viewport, 100, 2, 0).framelets);
    PlaneModel writing;
    std::vector<DisplayFramelet> decoded = batch.framelets;
    PlaneCodec codec;
    auto const written = codec.encode(batch.framelets, batch.qp, writing, &held, decoded);
    std::vector<std::uint8_t> const good(written.begin(), written.end());
    std::size_t refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::vector<std::uint8_t> bad = good;
        if (i % 3 == 0) {
            bad.resize(random() % bad.size());
            bad.shrink_to_fit();
        } else {
            bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
            bad[random() % std::min<std::size_t>(bad.size(), 100)] ^= static_cast<std::uint8_t>(1u << (random() % 8));
        }
        try {
            PlaneModel reading;
            PlaneCodec::decode(bad, decoded, batch.qp, reading, &held);
        } catch (ProtocolError const&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000u);
}

TEST(PredictedBatch, GoldenBytes) {
    // The example of PROTOCOL.md: two framelets of one grey each, over a picture that is grey and one that has been
    // sent.
    ReferencePicture held;
    held.show({32, 32});
    std::array<DisplayFramelet, 2> framelets;
    framelets[0].tile = make_tile(1, 0, 0);
    framelets[1].tile = make_tile(1, 1, 0);
    for (DisplayFramelet& framelet : framelets) {
        framelet.red.fill(140);
        framelet.green.fill(140);
        framelet.blue.fill(140);
    }
    std::vector<std::uint8_t> const golden{0xf7, 0x7f, 0x80, 0x19, 0xff, 0xfc, 0x24, 0x6c, 0xb8, 0xee, 0xfe};
    std::vector<std::uint8_t> qp(2);
    std::array<DisplayFramelet, 2> decoded = framelets;
    DisplayFramelet light = framelets[0];
    light.red.fill(200);
    light.green.fill(200);
    light.blue.fill(200);
    auto const decode = [&] {
        PlaneModel model;
        PlaneCodec::decode(golden, decoded, qp, model, &held);
    };
    decode();
    EXPECT_EQ(decoded[0], framelets[0]);
    EXPECT_EQ(decoded[1].green[0], 128); // the picture is as it was before this batch
    held.take(std::span(&light, 1));
    decode();
    EXPECT_EQ(decoded[0].green[0], 212);
    EXPECT_EQ(decoded[1].green[0], 200);
}

} // namespace
} // namespace framelet
