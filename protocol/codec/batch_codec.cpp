#include "protocol/codec/batch_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>

#include "common/error.h"
#include "common/per_thread.h"
#include "protocol/codec/color/plane_codec.h"
#include "protocol/codec/geometry/shape_codec.h"
#include "protocol/codec/geometry/track_codec.h"
#include "protocol/codec/zstd_frames.h"

namespace framelet {
namespace {

struct Worker {
    FrameCodec frames;
    std::vector<std::uint8_t> content;
    PlaneCodec planes;
    ShapeCodec shapes;

    /// Returns the length of the frame written to `out`. `quality` may be empty: without loss, in encoding 1. `held`
    /// and `decoded` as of PlaneCodec.
    std::size_t encode(std::span<DisplayFramelet const> group, std::span<std::uint8_t const> quality,
                       HeldPicture const* held, std::span<DisplayFramelet> decoded, std::span<std::byte> out) {
        if (!quality.empty()) {
            return frames.compress(planes.encode(group, quality, held, decoded), out);
        }
        content.resize(group.size() * exact_framelet_bytes);
        std::uint8_t* to = content.data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet const& framelet : group) {
                difference(framelet.*plane, to);
                to += framelet_samples;
            }
        });
        return frames.compress(std::array{std::span<std::uint8_t const>(content)}, out);
    }

    /// `quality` may be empty, as above. The frame has been checked.
    void decode(ByteView frame, std::span<DisplayFramelet> group, std::span<std::uint8_t> quality,
                HeldPicture const* held) {
        auto const bytes = frames.decompress(frame);
        if (!quality.empty()) {
            planes.decode(bytes, group, quality, held);
            return;
        }
        std::uint8_t const* from = bytes.data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet& framelet : group) {
                undo_difference(from, framelet.*plane);
                from += framelet_samples;
            }
        });
    }

    Bytes encode_tracks(Batch const& batch) {
        content = framelet::encode_tracks(batch.tracks, batch.camera_track);
        Bytes frame(most_frame_bytes(content.size()));
        frame.resize(frames.compress(std::array{std::span<std::uint8_t const>(content)}, frame));
        return frame;
    }

    Bytes encode_shapes(std::span<FrameletShape const> group, std::span<std::uint8_t const> side_bits) {
        ShapeParts const parts = shapes.encode(group, side_bits);
        std::size_t size = 0;
        for (auto const part : parts) {
            size += part.size();
        }
        Bytes frame(most_frame_bytes(size));
        frame.resize(frames.compress(parts, frame));
        return frame;
    }
};

/// Logarithms of the tiles' sides in pixels, to base 2; 0 where that is less than one.
template <typename Range, typename TileOf>
std::vector<std::uint8_t> side_bits_of(Range const& range, Viewport viewport, TileOf const& tile_of) {
    ImagePlane const plane(viewport);
    std::vector<std::uint8_t> bits(range.size());
    std::transform(range.begin(), range.end(), bits.begin(), [&](auto const& one) {
        auto const side = static_cast<unsigned>(plane.tile_side(tile_of(one)));
        return static_cast<std::uint8_t>(std::bit_width(side | 1u) - 1);
    });
    return bits;
}

/// Of a list that has something for every framelet or for none.
template <typename Value>
std::span<Value> part_of(std::span<Value> all, std::size_t first, std::size_t size) {
    return all.empty() ? all : all.subspan(first, size);
}

} // namespace

struct BatchCodec::Scratch {
    PerThread<Worker> workers;
    std::vector<std::byte> frames; ///< of all groups, each in a slot of the largest size it may need
    std::vector<DisplayFramelet> decoded; ///< of a batch that is encoded
};

BatchCodec::BatchCodec() : scratch_(std::make_unique<Scratch>()) {}
BatchCodec::~BatchCodec() = default;
BatchCodec::BatchCodec(BatchCodec&&) noexcept = default;
BatchCodec& BatchCodec::operator=(BatchCodec&&) noexcept = default;

EncodedBatch BatchCodec::encode(Batch const& batch, HeldPicture* held) {
    scratch_->workers.prepare();
    std::size_t const count = batch.framelets.size();
    FRAMELET_CHECK(count <= max_batch_framelets);
    FRAMELET_CHECK(batch.quality.empty() || batch.quality.size() == count);
    FRAMELET_CHECK(batch.shapes.empty() || batch.shapes.size() == count);
    std::span<std::uint8_t const> const quality = batch.quality;
    Viewport const viewport = batch.view.viewport;
    bool const is_predicted = held != nullptr && !quality.empty() && HeldPicture::holds(viewport);
    std::span<DisplayFramelet> decoded;
    if (is_predicted) {
        held->show(viewport);
        held->prepare_search(batch.framelets);
        scratch_->decoded.resize(std::max(scratch_->decoded.size(), count));
        decoded = std::span(scratch_->decoded).first(count);
        for (std::size_t i = 0; i < count; ++i) {
            decoded[i].tile = batch.framelets[i].tile;
        }
    }
    std::size_t const groups = group_count(count);
    std::size_t const slot = most_frame_bytes(quality.empty() ? group_framelets * exact_framelet_bytes
                                                              : most_predicted_bytes(group_framelets));
    if (scratch_->frames.size() < groups * slot) {
        scratch_->frames.resize(groups * slot);
    }
    std::vector<ByteView> frames(groups);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        std::span const out = std::span(scratch_->frames).subspan(group * slot, slot);
        frames[group] = out.first(scratch_->workers.local().encode(
            std::span(batch.framelets).subspan(first, size), part_of(quality, first, size),
            is_predicted ? held : nullptr, part_of(decoded, first, size), out));
    });
    if (held != nullptr && held->shows(viewport)) {
        held->take(is_predicted ? std::span<DisplayFramelet const>(decoded) : batch.framelets);
    }

    EncodedBatch encoded{batch.number,   batch.view, batch.scene_time,   batch.shown_from,
                         batch.outdates, {},         join_frames(frames)};
    encoded.encoding = is_predicted      ? SampleEncoding::predicted
                       : quality.empty() ? SampleEncoding::exact
                                         : SampleEncoding::haar;
    encoded.tiles.reserve(count);
    for (DisplayFramelet const& framelet : batch.framelets) {
        encoded.tiles.push_back(framelet.tile);
    }
    if (!batch.shapes.empty()) {
        encoded.shapes = encode_shapes(batch);
    }
    if (!batch.tracks.empty() || batch.camera_track) {
        encoded.tracks = scratch_->workers.local().encode_tracks(batch);
    }
    return encoded;
}

Bytes BatchCodec::encode_shapes(Batch const& batch) {
    auto const side_bits = side_bits_of(batch.framelets, batch.view.viewport,
                                        [](DisplayFramelet const& framelet) { return framelet.tile; });
    std::vector<Bytes> contents(group_count(batch.shapes.size()));
    for_each_group(batch.shapes.size(), [&](std::size_t group, std::size_t first, std::size_t size) {
        contents[group] = scratch_->workers.local().encode_shapes(std::span(batch.shapes).subspan(first, size),
                                                                  std::span(side_bits).subspan(first, size));
    });
    return join_frames(std::vector<ByteView>(contents.begin(), contents.end()));
}

Batch BatchCodec::decode(EncodedBatch const& encoded, HeldPicture* held) {
    Batch batch;
    decode(encoded, held, batch);
    return batch;
}

void BatchCodec::decode(EncodedBatch const& encoded, HeldPicture* held, Batch& batch) {
    scratch_->workers.prepare();
    std::size_t const count = encoded.tiles.size();
    if (count > max_batch_framelets) {
        throw ProtocolError("a batch has more than 32768 framelets");
    }
    bool const is_exact = encoded.encoding == SampleEncoding::exact;
    bool const is_predicted = encoded.encoding == SampleEncoding::predicted;
    Viewport const viewport = encoded.view.viewport;
    if (is_predicted && (held == nullptr || !HeldPicture::holds(viewport))) {
        throw ProtocolError("a batch is predicted from what this viewer does not hold");
    }
    bool const is_held = is_predicted || (held != nullptr && held->shows(viewport));
    ImagePlane const plane(viewport);
    if ((is_held || !encoded.shapes.empty()) &&
        !std::ranges::all_of(encoded.tiles, [&](Tile tile) { return plane.accepts(tile); })) {
        throw ProtocolError("a batch has a tile that its viewport does not have");
    }
    std::vector<ByteView> const frames = split_frames(encoded.payload, group_count(count));
    for (std::size_t group = 0; group < frames.size(); ++group) {
        std::size_t const first = group * group_framelets;
        std::size_t const size = std::min(group_framelets, count - first);
        std::size_t const exact = size * exact_framelet_bytes;
        std::size_t const lossy = is_predicted ? most_predicted_bytes(size) : most_plane_bytes(size);
        check_frame(frames[group], is_exact ? exact : 0, is_exact ? exact : lossy);
    }
    // Memory is asked for only now: the frames have said that they fill it, or how much less they hold.
    batch.number = encoded.number;
    batch.view = encoded.view;
    batch.scene_time = encoded.scene_time;
    batch.shown_from = encoded.shown_from;
    batch.outdates = encoded.outdates;
    batch.framelets.resize(count);
    batch.quality.resize(is_exact ? 0 : count);
    if (is_predicted) {
        held->show(viewport);
    }
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        std::span const framelets = std::span(batch.framelets).subspan(first, size);
        for (std::size_t i = 0; i < size; ++i) {
            framelets[i].tile = encoded.tiles[first + i];
        }
        scratch_->workers.local().decode(frames[group], framelets, part_of(std::span(batch.quality), first, size),
                                         is_predicted ? held : nullptr);
    });
    if (is_held) {
        held->take(batch.framelets);
    }
    decode_shapes(encoded, batch.shapes);
    batch.tracks.clear();
    batch.camera_track.reset();
    if (!encoded.tracks.empty()) {
        check_frame(encoded.tracks, 1, most_track_bytes);
        decode_tracks(scratch_->workers.local().frames.decompress(encoded.tracks), batch.tracks, batch.camera_track);
    }
}

void BatchCodec::decode_shapes(EncodedBatch const& encoded, std::vector<FrameletShape>& shapes) {
    if (encoded.shapes.empty()) {
        shapes.clear();
        return;
    }
    std::size_t const count = encoded.tiles.size();
    std::vector<ByteView> const frames = split_frames(encoded.shapes, group_count(count));
    for (std::size_t group = 0; group < frames.size(); ++group) {
        check_frame(frames[group], 0, most_shape_bytes(std::min(group_framelets, count - group * group_framelets)));
    }
    auto const side_bits = side_bits_of(encoded.tiles, encoded.view.viewport, std::identity{});
    shapes.resize(count);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        ShapeCodec::decode(scratch_->workers.local().frames.decompress(frames[group]),
                           std::span(side_bits).subspan(first, size), std::span(shapes).subspan(first, size));
    });
}

} // namespace framelet
