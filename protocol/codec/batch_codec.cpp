#include "protocol/codec/batch_codec.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "common/error.h"
#include "common/per_thread.h"
#include "protocol/codec/color/exact_planes.h"
#include "protocol/codec/color/plane_codec.h"
#include "protocol/codec/geometry/shape_coding.h"
#include "protocol/codec/geometry/track_codec.h"
#include "protocol/codec/zstd_frames.h"

namespace framelet {

struct BatchModels {
    PlaneModel planes;
    ShapeModel shapes;
};

BatchMemory::BatchMemory() : models(std::make_unique<BatchModels>()) {}
BatchMemory::~BatchMemory() = default;
BatchMemory::BatchMemory(BatchMemory&&) noexcept = default;
BatchMemory& BatchMemory::operator=(BatchMemory&&) noexcept = default;

namespace {

struct Worker {
    FrameCodec frames;
    std::vector<std::uint8_t> content;
    PlaneCodec planes;
    RangeWriter shapes;

    /// Compresses the samples of a group without loss, in encoding 1.
    void encode(std::span<DisplayFramelet const> group, Bytes& frame) {
        content.resize(group.size() * exact_framelet_bytes);
        std::uint8_t* to = content.data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet const& framelet : group) {
                difference(framelet.*plane, to);
                to += framelet_samples;
            }
        });
        frames.compress(content, frame);
    }

    /// Decompresses a frame, which must have been checked, into the samples of a group.
    void decode(ByteView frame, std::span<DisplayFramelet> group) {
        std::uint8_t const* from = frames.decompress(frame).data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet& framelet : group) {
                undo_difference(from, framelet.*plane);
                from += framelet_samples;
            }
        });
    }

    Bytes encode_tracks(Batch const& batch) {
        Bytes frame;
        frames.compress(framelet::encode_tracks(batch.tracks, batch.camera_track), frame);
        return frame;
    }
};

/// Copies into bytes whose memory is reused.
void copy(std::span<std::uint8_t const> from, Bytes& to) {
    auto const bytes = std::as_bytes(from);
    to.assign(bytes.begin(), bytes.end());
}

std::span<std::uint8_t const> numbers(ByteView bytes) {
    return {reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size()};
}

TilePosition position_of(ImagePlane const& plane, Tile tile) {
    PixelRect const rect = plane.tile_rect(tile);
    auto const side = static_cast<unsigned>(plane.tile_side(tile));
    return {rect.left, rect.top, static_cast<std::int32_t>(std::bit_width(side | 1u)) - 1};
}

/// Part of a list that has something for every framelet or is empty.
template <typename Value>
std::span<Value> part_of(std::span<Value> all, std::size_t first, std::size_t size) {
    return all.empty() ? all : all.subspan(first, size);
}

/// The models of the groups of a batch. All begin with what earlier batches have taught; what the first group learns
/// stays for the next batch, what the others learn is forgotten.
template <class Model>
class GroupModels {
public:
    /// `others`: scratch for the models of all groups but the first.
    GroupModels(Model& model, std::size_t groups, std::vector<Model>& others) : model_(model), others_(others) {
        others_.assign(groups > 1 ? groups - 1 : 0, model);
    }
    Model& operator[](std::size_t group) { return group == 0 ? model_ : others_[group - 1]; }

private:
    Model& model_;
    std::vector<Model>& others_;
};

/// Moment of a batch: its own, which is remembered, or that of the batch before. ProtocolError where there is neither.
BatchMoment moment_of(EncodedBatch const& encoded, BatchMemory* memory) {
    if (!encoded.moment && (memory == nullptr || !memory->moment)) {
        throw ProtocolError("a batch has no moment, and none came before it");
    }
    if (memory != nullptr && encoded.moment) {
        memory->moment = encoded.moment;
    }
    return encoded.moment ? *encoded.moment : *memory->moment;
}

} // namespace

struct BatchCodec::Scratch {
    PerThread<Worker> workers;
    std::vector<Bytes> frames; ///< one of each group
    std::vector<DisplayFramelet> decoded; ///< what a viewer will see of the batch that is being encoded
    std::unique_ptr<BatchModels> alone; ///< models for a batch without a memory
    std::vector<PlaneModel> planes; ///< models of all groups but the first; `shapes` likewise
    std::vector<ShapeModel> shapes;

    std::span<Bytes> frames_of(std::size_t groups) {
        frames.resize(std::max(frames.size(), groups));
        return std::span(frames).first(groups);
    }
    BatchModels& models_of(BatchMemory* memory) {
        if (memory != nullptr) {
            return *memory->models;
        }
        alone = std::make_unique<BatchModels>();
        return *alone;
    }
};

BatchCodec::BatchCodec() : scratch_(std::make_unique<Scratch>()) {}
BatchCodec::~BatchCodec() = default;
BatchCodec::BatchCodec(BatchCodec&&) noexcept = default;
BatchCodec& BatchCodec::operator=(BatchCodec&&) noexcept = default;

EncodedBatch BatchCodec::encode(Batch const& batch, BatchMemory* memory, bool predicts) {
    scratch_->workers.prepare();
    std::size_t const count = batch.framelets.size();
    FRAMELET_CHECK(count <= max_batch_framelets);
    FRAMELET_CHECK(batch.qp.empty() || batch.qp.size() == count);
    FRAMELET_CHECK(batch.shapes.empty() || batch.shapes.size() == count);
    std::span<std::uint8_t const> const qp = batch.qp;
    Viewport const viewport = batch.view.viewport;
    bool const is_predicted = memory != nullptr && predicts && !qp.empty() && ReferencePicture::holds(viewport);
    std::span<DisplayFramelet> decoded;
    if (is_predicted) {
        memory->picture.show(viewport);
        memory->picture.prepare_search(batch.framelets);
        scratch_->decoded.resize(std::max(scratch_->decoded.size(), count));
        decoded = std::span(scratch_->decoded).first(count);
        for (std::size_t i = 0; i < count; ++i) {
            decoded[i].tile = batch.framelets[i].tile;
        }
    }
    BatchModels& models = scratch_->models_of(memory);
    std::size_t const groups = group_count(count);
    GroupModels<PlaneModel> planes(models.planes, qp.empty() ? 0 : groups, scratch_->planes);
    std::span<Bytes> const frames = scratch_->frames_of(groups);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        Worker& worker = scratch_->workers.local();
        std::span const framelets = std::span(batch.framelets).subspan(first, size);
        if (qp.empty()) {
            worker.encode(framelets, frames[group]);
        } else {
            copy(worker.planes.encode(framelets, qp.subspan(first, size), planes[group],
                                      is_predicted ? &memory->picture : nullptr, part_of(decoded, first, size)),
                 frames[group]);
        }
    });
    if (memory != nullptr && memory->picture.shows(viewport)) {
        memory->picture.take(is_predicted ? std::span<DisplayFramelet const>(decoded) : batch.framelets);
    }

    EncodedBatch encoded{batch.number,
                         BatchMoment{batch.view, batch.scene_time, batch.shown_from, batch.outdates},
                         {},
                         join_frames(frames)};
    if (memory != nullptr && std::exchange(memory->moment, encoded.moment) == encoded.moment) {
        encoded.moment.reset();
    }
    encoded.encoding = is_predicted ? SampleEncoding::predicted
                       : qp.empty() ? SampleEncoding::exact
                                    : SampleEncoding::haar;
    encoded.tiles.reserve(count);
    for (DisplayFramelet const& framelet : batch.framelets) {
        encoded.tiles.push_back(framelet.tile);
    }
    if (!batch.shapes.empty()) {
        encoded.shapes = encode_shapes(batch, models);
    }
    if (!batch.tracks.empty() || batch.camera_track) {
        encoded.tracks = scratch_->workers.local().encode_tracks(batch);
    }
    return encoded;
}

Bytes BatchCodec::encode_shapes(Batch const& batch, BatchModels& models) {
    ImagePlane const plane(batch.view.viewport);
    std::size_t const count = batch.shapes.size();
    GroupModels<ShapeModel> shapes(models.shapes, group_count(count), scratch_->shapes);
    std::span<Bytes> const frames = scratch_->frames_of(group_count(count));
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        RangeWriter& writer = scratch_->workers.local().shapes;
        writer.begin();
        for (std::size_t i = first; i < first + size; ++i) {
            shapes[group].write(writer, position_of(plane, batch.framelets[i].tile), batch.shapes[i]);
        }
        copy(writer.finish(), frames[group]);
    });
    return join_frames(frames);
}

Batch BatchCodec::decode(EncodedBatch const& encoded, BatchMemory* memory) {
    Batch batch;
    decode(encoded, memory, batch);
    return batch;
}

void BatchCodec::decode(EncodedBatch const& encoded, BatchMemory* memory, Batch& batch) {
    scratch_->workers.prepare();
    std::size_t const count = encoded.tiles.size();
    if (count > max_batch_framelets) {
        throw ProtocolError("a batch has more than 32768 framelets");
    }
    bool const is_exact = encoded.encoding == SampleEncoding::exact;
    bool const is_predicted = encoded.encoding == SampleEncoding::predicted;
    BatchMoment const moment = moment_of(encoded, memory);
    Viewport const viewport = moment.view.viewport;
    if (is_predicted && (memory == nullptr || !ReferencePicture::holds(viewport))) {
        throw ProtocolError("a batch is predicted from what this viewer does not hold");
    }
    ImagePlane const plane(viewport);
    if (!std::ranges::all_of(encoded.tiles, [&](Tile tile) { return plane.accepts(tile); })) {
        throw ProtocolError("a batch has a tile that its viewport does not have");
    }
    std::vector<ByteView> const frames = split_frames(encoded.payload, group_count(count));
    for (std::size_t group = 0; group < frames.size() && is_exact; ++group) {
        std::size_t const first = group * group_framelets;
        std::size_t const exact = std::min(group_framelets, count - first) * exact_framelet_bytes;
        check_frame(frames[group], exact, exact);
    }
    BatchModels& models = scratch_->models_of(memory);
    batch.number = encoded.number;
    batch.view = moment.view;
    batch.scene_time = moment.scene_time;
    batch.shown_from = moment.shown_from;
    batch.outdates = moment.outdates;
    batch.framelets.resize(count);
    batch.qp.resize(is_exact ? 0 : count);
    if (is_predicted) {
        memory->picture.show(viewport);
    }
    GroupModels<PlaneModel> planes(models.planes, is_exact ? 0 : frames.size(), scratch_->planes);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        std::span const framelets = std::span(batch.framelets).subspan(first, size);
        for (std::size_t i = 0; i < size; ++i) {
            framelets[i].tile = encoded.tiles[first + i];
        }
        if (is_exact) {
            scratch_->workers.local().decode(frames[group], framelets);
        } else {
            PlaneCodec::decode(numbers(frames[group]), framelets, std::span(batch.qp).subspan(first, size),
                               planes[group], is_predicted ? &memory->picture : nullptr);
        }
    });
    if (memory != nullptr && memory->picture.shows(viewport)) {
        memory->picture.take(batch.framelets);
    }
    decode_shapes(encoded, plane, models, batch.shapes);
    batch.tracks.clear();
    batch.camera_track.reset();
    if (!encoded.tracks.empty()) {
        check_frame(encoded.tracks, 1, most_track_bytes);
        decode_tracks(scratch_->workers.local().frames.decompress(encoded.tracks), batch.tracks, batch.camera_track);
    }
}

void BatchCodec::decode_shapes(EncodedBatch const& encoded, ImagePlane const& plane, BatchModels& models,
                               std::vector<FrameletShape>& shapes) {
    if (encoded.shapes.empty()) {
        shapes.clear();
        return;
    }
    std::size_t const count = encoded.tiles.size();
    std::vector<ByteView> const frames = split_frames(encoded.shapes, group_count(count));
    GroupModels<ShapeModel> group_models(models.shapes, frames.size(), scratch_->shapes);
    shapes.resize(count);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        RangeReader reader(numbers(frames[group]));
        for (std::size_t i = first; i < first + size; ++i) {
            group_models[group].read(reader, position_of(plane, encoded.tiles[i]), shapes[i]);
        }
        if (!reader.is_at_end()) {
            throw ProtocolError("the shapes of a group are longer than its framelets");
        }
    });
}

} // namespace framelet
