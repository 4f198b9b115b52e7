// Sends whole batches, with shapes and tracks, through codec and message.
#include <string>
#include <string_view>
#include <variant>

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"
#include "random_shape.h"

namespace framelet {
namespace {

Batch plain_batch(std::size_t count) {
    Batch batch;
    batch.number = 7;
    batch.view.viewport = {1280, 720};
    batch.scene_time = 1.5;
    for (std::size_t i = 0; i < count; ++i) {
        DisplayFramelet& framelet = batch.framelets.emplace_back();
        framelet.tile = make_tile(7, static_cast<std::uint32_t>(i % 80), static_cast<std::uint32_t>(i / 80));
        framelet.red.fill(static_cast<std::uint8_t>(i));
        framelet.green.fill(10);
        framelet.blue.fill(20);
    }
    return batch;
}

/// Two framelets that all codings keep as they are: the second one shows a body in front of the ground.
Batch small_batch() {
    Batch batch = plain_batch(2);
    batch.shapes.resize(2);
    batch.shapes[0].layer_count = 1;
    batch.shapes[0].layers[0].at = 0.5f;
    batch.shapes[1].layer_count = 2;
    batch.shapes[1].decorrelation = 90;
    batch.shapes[1].layers[0].at = 0.5f;
    batch.shapes[1].layers[1] = {1, 0.0078125f, 0, 0x1p-9f, 3, {}}; // its error is the unit of its plane
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        batch.shapes[1].layer_of[i] = morton_x(i) < 5 ? 0 : 1;
    }
    batch.shapes[1].layer_of[255] = FrameletShape::outlier;
    batch.shapes[1].outliers.push_back({0.25f, 3, {}});
    batch.tracks.push_back({3, 90, {BodyPose{}, BodyPose{{1, 2, 3}, {0, 0, 1, 0}, {1, 1, 2}}}});
    return batch;
}

Batch through_the_wire(Batch const& batch) {
    return BatchCodec().decode(std::get<EncodedBatch>(decode_message(encode_message(BatchCodec().encode(batch)))));
}

TEST(BatchMessage, ShapesAndTracksArrive) {
    Batch batch = small_batch();
    batch.shown_from = 1.25;
    batch.outdates = true;
    EXPECT_TRUE(through_the_wire(batch) == batch);
}

TEST(BatchMessage, GoldenMessage) {
    // The message as one version of the libraries wrote it: others may write it otherwise, all must read it.
    constexpr std::string_view hex =
        "1400000046524d4c0000000008000e00070008000800000000000007180000000000120024001c00080007000c001000"
        "14001800120000000000000124000000780000007c000000a0000000c400000007000000000000000800120004000800"
        "0800000018000000000000000000f83f00000a000c000000040008000a000000140000000005d0020c00240004001000"
        "000020000c0000000000000000000000000000000000000000000000000000000000803fcdcc4c3f0300000001070000"
        "2200000028b52ffd600005c5000060000001000a000a0014001400065402002bfbfd7ebfdf07000022000000ce001700"
        "101f4ea605aa2ff8f698e0a1d07e32040000000000013560149bd033efd000003b00000028b52ffd20329101000103b4"
        "01028e008080200080804000808060900000008080080000808008ffff0f8e808020ffff1f808020ffff1f8080200000";
    Bytes golden;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        golden.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    }
    EXPECT_TRUE(BatchCodec().decode(std::get<EncodedBatch>(decode_message(golden))) == small_batch());
}

TEST(BatchMessage, NothingIsSentOfWhatThereIsNot) {
    Batch const batch = plain_batch(3);
    EncodedBatch const encoded = BatchCodec().encode(batch);
    EXPECT_TRUE(encoded.shapes.empty());
    EXPECT_TRUE(through_the_wire(batch) == batch);
}

TEST(BatchMessage, SeveralGroups) {
    Batch batch = plain_batch(300);
    RandomShapes random(1);
    for (std::size_t i = 0; i < batch.framelets.size(); ++i) {
        batch.shapes.push_back(random.shape(i / 128 == 1));
    }
    Batch const once = through_the_wire(batch);
    ASSERT_EQ(once.shapes.size(), batch.shapes.size());
    for (std::size_t i = 0; i < batch.shapes.size(); ++i) {
        EXPECT_EQ(once.shapes[i].layer_of, batch.shapes[i].layer_of);
    }
    EXPECT_EQ(BatchCodec().encode(batch).shapes, BatchCodec().encode(batch).shapes);
}

TEST(BatchMessage, ShapesOfOtherFrameletsAreRefused) {
    EncodedBatch encoded = BatchCodec().encode(small_batch());
    encoded.tiles.pop_back();
    encoded.payload = BatchCodec().encode(plain_batch(1)).payload;
    EXPECT_THROW(BatchCodec().decode(encoded), ProtocolError);
    encoded = BatchCodec().encode(small_batch());
    encoded.shapes.insert(encoded.shapes.end(), 8, std::byte{1});
    EXPECT_THROW(BatchCodec().decode(encoded), ProtocolError);
}

TEST(BatchMessage, EveryFlippedBitIsRefusedOrDecoded) {
    Bytes const good = encode_message(BatchCodec().encode(small_batch()));
    BatchCodec codec;
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
        Bytes bytes = good;
        bytes[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        try {
            Message const message = decode_message(bytes);
            if (auto const* const encoded = std::get_if<EncodedBatch>(&message)) {
                Batch const batch = codec.decode(*encoded);
                codec.encode(batch); // what was taken can be sent again
            }
        } catch (ProtocolError const&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, good.size());
}

} // namespace
} // namespace framelet
