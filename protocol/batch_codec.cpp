#include "protocol/batch_codec.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <zstd.h>

#include "common/error.h"

namespace framelet {
namespace {

using Samples = std::array<std::uint8_t, framelet_samples>;

/// Framelets that are compressed together, and apart from the others: enough for the compressor to learn from, few
/// enough to stay in the cache and to give every core some.
constexpr std::size_t group_framelets = 128;
constexpr auto framelet_bytes = std::size_t{3} * framelet_samples;
constexpr int compression_level = 1;
constexpr std::size_t length_bytes = 4;
/// First bytes of a zstd frame (RFC 8878); other kinds of frames that the library knows are not part of the format.
constexpr std::array<std::uint8_t, 4> zstd_magic{0x28, 0xb5, 0x2f, 0xfd};

constexpr std::array<Samples DisplayFramelet::*, 3> planes{&DisplayFramelet::red, &DisplayFramelet::green,
                                                           &DisplayFramelet::blue};

constexpr std::array<std::uint8_t, framelet_samples> make_morton_of_raster() {
    std::array<std::uint8_t, framelet_samples> table{};
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        table[i] = static_cast<std::uint8_t>(morton_index(i % framelet_side, i / framelet_side));
    }
    return table;
}
constexpr auto morton_of_raster = make_morton_of_raster();

/// 256 samples in Morton order to 256 differences in raster order, modulo 256: to the left neighbour, in the first
/// column to the upper one.
void difference(Samples const& samples, std::uint8_t* out) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        above = samples[morton_of_raster[row]];
        for (std::size_t i = row; i < row + framelet_side; ++i) {
            std::uint8_t const sample = samples[morton_of_raster[i]];
            out[i] = static_cast<std::uint8_t>(sample - previous);
            previous = sample;
        }
    }
}

void undo_difference(std::uint8_t const* in, Samples& samples) {
    std::uint8_t above = 0;
    for (std::size_t row = 0; row < framelet_samples; row += framelet_side) {
        std::uint8_t previous = above;
        for (std::size_t i = row; i < row + framelet_side; ++i) {
            previous = static_cast<std::uint8_t>(previous + in[i]);
            samples[morton_of_raster[i]] = previous;
        }
        above = samples[morton_of_raster[row]];
    }
}

std::size_t group_count(std::size_t framelets) {
    return (framelets + group_framelets - 1) / group_framelets;
}

void put_length(std::byte* out, std::size_t length) {
    for (std::size_t i = 0; i < length_bytes; ++i) {
        out[i] = static_cast<std::byte>(length >> (8 * i));
    }
}

std::size_t get_length(std::byte const* in) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) {
        length |= std::to_integer<std::size_t>(in[i]) << (8 * i);
    }
    return length;
}

/// The frames of the groups, where the lengths in front of them say they are. Nothing is decompressed yet.
std::vector<ByteView> split_payload(ByteView payload, std::size_t groups) {
    if (payload.size() < groups * length_bytes) {
        throw ProtocolError("a batch's payload is too short for its tiles");
    }
    std::vector<ByteView> frames;
    ByteView rest = payload.subspan(groups * length_bytes);
    for (std::size_t group = 0; group < groups; ++group) {
        std::size_t const length = get_length(&payload[group * length_bytes]);
        if (length > rest.size()) {
            throw ProtocolError("a batch's payload is shorter than its groups");
        }
        frames.push_back(rest.first(length));
        rest = rest.subspan(length);
    }
    if (!rest.empty()) {
        throw ProtocolError("a batch's payload is longer than its groups");
    }
    return frames;
}

/// Refuses all but one zstd frame that says it holds `size` bytes.
void check_frame(ByteView frame, std::size_t size) {
    if (frame.size() < zstd_magic.size() || std::memcmp(frame.data(), zstd_magic.data(), zstd_magic.size()) != 0) {
        throw ProtocolError("a group of a batch is not a zstd frame");
    }
    if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != size) {
        throw ProtocolError("a group of a batch does not hold what its tiles need");
    }
    if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
        throw ProtocolError("a group of a batch is not exactly one zstd frame");
    }
}

struct Worker {
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor{nullptr, ZSTD_freeCCtx};
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> decompressor{nullptr, ZSTD_freeDCtx};
    std::vector<std::uint8_t> differences = std::vector<std::uint8_t>(group_framelets * framelet_bytes);

    /// Returns the length of the frame written to `out`.
    std::size_t encode(std::span<DisplayFramelet const> group, std::span<std::byte> out) {
        std::uint8_t* to = differences.data();
        for (auto const plane : planes) {
            for (DisplayFramelet const& framelet : group) {
                difference(framelet.*plane, to);
                to += framelet_samples;
            }
        }
        if (!compressor) {
            compressor.reset(ZSTD_createCCtx());
            FRAMELET_CHECK(compressor != nullptr);
        }
        std::size_t const length = ZSTD_compressCCtx(compressor.get(), out.data(), out.size(), differences.data(),
                                                     group.size() * framelet_bytes, compression_level);
        FRAMELET_CHECK(!ZSTD_isError(length));
        return length;
    }

    void decode(ByteView frame, std::span<DisplayFramelet> group) {
        if (!decompressor) {
            decompressor.reset(ZSTD_createDCtx());
            FRAMELET_CHECK(decompressor != nullptr);
        }
        std::size_t const size = group.size() * framelet_bytes;
        if (ZSTD_decompressDCtx(decompressor.get(), differences.data(), size, frame.data(), frame.size()) != size) {
            throw ProtocolError("a group of a batch cannot be decompressed");
        }
        std::uint8_t const* from = differences.data();
        for (auto const plane : planes) {
            for (DisplayFramelet& framelet : group) {
                undo_difference(from, framelet.*plane);
                from += framelet_samples;
            }
        }
    }
};

/// Calls `body(group, first framelet, count)` for every group, in parallel.
template <typename Body>
void for_each_group(std::size_t framelets, Body const& body) {
    tbb::parallel_for(std::size_t{0}, group_count(framelets), [&](std::size_t group) {
        std::size_t const first = group * group_framelets;
        body(group, first, std::min(group_framelets, framelets - first));
    });
}

} // namespace

struct BatchCodec::Scratch {
    tbb::enumerable_thread_specific<Worker> workers;
    std::vector<std::byte> frames; ///< of all groups, each in a slot of the largest size it may need
    std::vector<std::size_t> lengths;
};

BatchCodec::BatchCodec() : scratch_(std::make_unique<Scratch>()) {}
BatchCodec::~BatchCodec() = default;
BatchCodec::BatchCodec(BatchCodec&&) noexcept = default;
BatchCodec& BatchCodec::operator=(BatchCodec&&) noexcept = default;

EncodedBatch BatchCodec::encode(Batch const& batch) {
    std::size_t const count = batch.framelets.size();
    FRAMELET_CHECK(count <= max_batch_framelets);
    std::size_t const groups = group_count(count);
    std::size_t const slot = ZSTD_compressBound(group_framelets * framelet_bytes);
    if (scratch_->frames.size() < groups * slot) {
        scratch_->frames.resize(groups * slot);
    }
    scratch_->lengths.resize(groups);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        scratch_->lengths[group] = scratch_->workers.local().encode(
            std::span(batch.framelets).subspan(first, size), std::span(scratch_->frames).subspan(group * slot, slot));
    });

    EncodedBatch encoded{batch.number, batch.view, batch.scene_time, {}, {}};
    encoded.tiles.reserve(count);
    for (DisplayFramelet const& framelet : batch.framelets) {
        encoded.tiles.push_back(framelet.tile);
    }
    std::size_t total = groups * length_bytes;
    for (std::size_t const length : scratch_->lengths) {
        total += length;
    }
    encoded.payload.reserve(total);
    encoded.payload.resize(groups * length_bytes);
    for (std::size_t group = 0; group < groups; ++group) {
        std::size_t const length = scratch_->lengths[group];
        put_length(&encoded.payload[group * length_bytes], length);
        auto const frame = scratch_->frames.begin() + static_cast<std::ptrdiff_t>(group * slot);
        encoded.payload.insert(encoded.payload.end(), frame, frame + static_cast<std::ptrdiff_t>(length));
    }
    return encoded;
}

Batch BatchCodec::decode(EncodedBatch const& encoded) {
    std::size_t const count = encoded.tiles.size();
    if (count > max_batch_framelets) {
        throw ProtocolError("a batch has more than 32768 framelets");
    }
    std::vector<ByteView> const frames = split_payload(encoded.payload, group_count(count));
    for (std::size_t group = 0; group < frames.size(); ++group) {
        std::size_t const first = group * group_framelets;
        check_frame(frames[group], std::min(group_framelets, count - first) * framelet_bytes);
    }
    // Memory is asked for only now: the frames have said that they fill it.
    Batch batch{encoded.number, encoded.view, encoded.scene_time, std::vector<DisplayFramelet>(count)};
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        std::span const framelets = std::span(batch.framelets).subspan(first, size);
        for (std::size_t i = 0; i < size; ++i) {
            framelets[i].tile = encoded.tiles[first + i];
        }
        scratch_->workers.local().decode(frames[group], framelets);
    });
    return batch;
}

} // namespace framelet
