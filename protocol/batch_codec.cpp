#include "protocol/batch_codec.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <zstd.h>

#include "common/error.h"
#include "protocol/plane_codec.h"

namespace framelet {
namespace {

/// Framelets that are compressed together, and apart from the others: enough for the compressor to learn from, few
/// enough to stay in the cache and to give every core some.
constexpr std::size_t group_framelets = 128;
constexpr int compression_level = 1;
constexpr std::size_t length_bytes = 4;
/// First bytes of a zstd frame (RFC 8878); other kinds of frames that the library knows are not part of the format.
constexpr std::array<std::uint8_t, 4> zstd_magic{0x28, 0xb5, 0x2f, 0xfd};

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

/// Refuses all but one zstd frame that says how many bytes it holds, and these a number that `is_possible`.
template <typename IsPossible>
void check_frame(ByteView frame, IsPossible const& is_possible) {
    if (frame.size() < zstd_magic.size() || std::memcmp(frame.data(), zstd_magic.data(), zstd_magic.size()) != 0) {
        throw ProtocolError("a group of a batch is not a zstd frame");
    }
    // Where the size is unknown or the header damaged this is near 2^64.
    if (!is_possible(ZSTD_getFrameContentSize(frame.data(), frame.size()))) {
        throw ProtocolError("a group of a batch does not hold what its tiles need");
    }
    if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
        throw ProtocolError("a group of a batch is not exactly one zstd frame");
    }
}

struct Worker {
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor{nullptr, ZSTD_freeCCtx};
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> decompressor{nullptr, ZSTD_freeDCtx};
    std::vector<std::uint8_t> content;
    PlaneCodec planes;

    /// Returns the length of the frame written to `out`. `quality` may be empty: without loss, in encoding 1.
    std::size_t encode(std::span<DisplayFramelet const> group, std::span<std::uint8_t const> quality,
                       std::span<std::byte> out) {
        if (!quality.empty()) {
            return compress(planes.encode(group, quality), out);
        }
        content.resize(group.size() * exact_framelet_bytes);
        std::uint8_t* to = content.data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet const& framelet : group) {
                difference(framelet.*plane, to);
                to += framelet_samples;
            }
        });
        return compress(std::array{std::span<std::uint8_t const>(content)}, out);
    }

    /// One frame; each part begins a block of its own, so that it has its own statistics.
    template <std::size_t count>
    std::size_t compress(std::array<std::span<std::uint8_t const>, count> const& parts, std::span<std::byte> out) {
        if (!compressor) {
            compressor.reset(ZSTD_createCCtx());
            FRAMELET_CHECK(compressor != nullptr);
            ZSTD_CCtx_setParameter(compressor.get(), ZSTD_c_compressionLevel, compression_level);
        }
        std::size_t size = 0;
        for (auto const part : parts) {
            size += part.size();
        }
        ZSTD_CCtx_reset(compressor.get(), ZSTD_reset_session_only);
        ZSTD_CCtx_setPledgedSrcSize(compressor.get(), size);
        ZSTD_outBuffer to{out.data(), out.size(), 0};
        for (std::size_t i = 0; i < count; ++i) {
            ZSTD_inBuffer from{parts[i].data(), parts[i].size(), 0};
            std::size_t const left =
                ZSTD_compressStream2(compressor.get(), &to, &from, i + 1 < count ? ZSTD_e_flush : ZSTD_e_end);
            FRAMELET_CHECK(left == 0);
        }
        return to.pos;
    }

    /// `quality` may be empty, as above. The frame has been checked.
    void decode(ByteView frame, std::span<DisplayFramelet> group, std::span<std::uint8_t> quality) {
        if (!decompressor) {
            decompressor.reset(ZSTD_createDCtx());
            FRAMELET_CHECK(decompressor != nullptr);
        }
        std::size_t const size = ZSTD_getFrameContentSize(frame.data(), frame.size());
        content.resize(size);
        if (ZSTD_decompressDCtx(decompressor.get(), content.data(), size, frame.data(), frame.size()) != size) {
            throw ProtocolError("a group of a batch cannot be decompressed");
        }
        if (!quality.empty()) {
            planes.decode(content, group, quality);
            return;
        }
        std::uint8_t const* from = content.data();
        for_each_plane([&](auto const plane) {
            for (DisplayFramelet& framelet : group) {
                undo_difference(from, framelet.*plane);
                from += framelet_samples;
            }
        });
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

/// Of a list that has something for every framelet or for none.
template <typename Value>
std::span<Value> part_of(std::span<Value> all, std::size_t first, std::size_t size) {
    return all.empty() ? all : all.subspan(first, size);
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
    FRAMELET_CHECK(batch.quality.empty() || batch.quality.size() == count);
    std::size_t const groups = group_count(count);
    // Three blocks more than one pass needs.
    std::size_t const slot = ZSTD_compressBound(batch.quality.empty() ? group_framelets * exact_framelet_bytes
                                                                      : most_plane_bytes(group_framelets)) +
                             64;
    if (scratch_->frames.size() < groups * slot) {
        scratch_->frames.resize(groups * slot);
    }
    scratch_->lengths.resize(groups);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        scratch_->lengths[group] = scratch_->workers.local().encode(
            std::span(batch.framelets).subspan(first, size), part_of(std::span(batch.quality), first, size),
            std::span(scratch_->frames).subspan(group * slot, slot));
    });

    EncodedBatch encoded{batch.number, batch.view, batch.scene_time, {}, {}};
    encoded.encoding = batch.quality.empty() ? SampleEncoding::exact : SampleEncoding::haar;
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
    bool const is_exact = encoded.encoding == SampleEncoding::exact;
    for (std::size_t group = 0; group < frames.size(); ++group) {
        std::size_t const first = group * group_framelets;
        std::size_t const size = std::min(group_framelets, count - first);
        check_frame(frames[group], [&](unsigned long long bytes) {
            return is_exact ? bytes == size * exact_framelet_bytes : bytes <= most_plane_bytes(size);
        });
    }
    // Memory is asked for only now: the frames have said that they fill it, or how much less they hold.
    Batch batch{encoded.number, encoded.view, encoded.scene_time, std::vector<DisplayFramelet>(count)};
    batch.quality.resize(is_exact ? 0 : count);
    for_each_group(count, [&](std::size_t group, std::size_t first, std::size_t size) {
        std::span const framelets = std::span(batch.framelets).subspan(first, size);
        for (std::size_t i = 0; i < size; ++i) {
            framelets[i].tile = encoded.tiles[first + i];
        }
        scratch_->workers.local().decode(frames[group], framelets, part_of(std::span(batch.quality), first, size));
    });
    return batch;
}

} // namespace framelet
