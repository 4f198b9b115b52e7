#include "protocol/codec/zstd_frames.h"

#include <array>
#include <cstring>
#include <new>

#include <zstd_errors.h>

#include "common/error.h"

namespace framelet {
namespace {

constexpr int compression_level = 1;
/// The least length of a repetition, bytes: shorter ones are left to the entropy stage, since in differences of
/// neighbours they are chance.
constexpr int least_match = 7;
constexpr std::size_t length_bytes = 4;
/// First bytes of a zstd frame ([RFC 8878]); other kinds of frames that the library knows are not part of the format.
constexpr std::array<std::uint8_t, 4> zstd_magic{0x28, 0xb5, 0x2f, 0xfd};

/// Number of lengths that are stated: the last frame takes what is left.
std::size_t stated_lengths(std::size_t groups) {
    return groups > 0 ? groups - 1 : 0;
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

/// Returns what the library has made. Throws std::bad_alloc where it is null: memory is all that is needed for it.
template <typename Context>
Context* made(Context* context) {
    if (context == nullptr) {
        throw std::bad_alloc();
    }
    return context;
}

} // namespace

Bytes join_frames(std::span<Bytes const> frames) {
    std::size_t const lengths = stated_lengths(frames.size());
    std::size_t total = lengths * length_bytes;
    for (Bytes const& frame : frames) {
        total += frame.size();
    }
    Bytes payload;
    payload.reserve(total);
    payload.resize(lengths * length_bytes);
    for (std::size_t group = 0; group < frames.size(); ++group) {
        if (group < lengths) {
            put_length(&payload[group * length_bytes], frames[group].size());
        }
        payload.insert(payload.end(), frames[group].begin(), frames[group].end());
    }
    return payload;
}

std::vector<ByteView> split_frames(ByteView payload, std::size_t groups) {
    std::size_t const lengths = stated_lengths(groups);
    if (payload.size() < lengths * length_bytes) {
        throw ProtocolError("a batch's payload is too short for its tiles");
    }
    std::vector<ByteView> frames;
    ByteView rest = payload.subspan(lengths * length_bytes);
    for (std::size_t group = 0; group < lengths; ++group) {
        std::size_t const length = get_length(&payload[group * length_bytes]);
        if (length > rest.size()) {
            throw ProtocolError("a batch's payload is shorter than its groups");
        }
        frames.push_back(rest.first(length));
        rest = rest.subspan(length);
    }
    if (groups > 0) {
        frames.push_back(rest);
    } else if (!rest.empty()) {
        throw ProtocolError("a batch's payload is longer than its groups");
    }
    return frames;
}

void check_frame(ByteView frame, std::size_t least, std::size_t most) {
    if (frame.size() < zstd_magic.size() || std::memcmp(frame.data(), zstd_magic.data(), zstd_magic.size()) != 0) {
        throw ProtocolError("a group of a batch is not a zstd frame");
    }
    // The size is near 2^64 where it is unknown or the header damaged.
    unsigned long long const size = ZSTD_getFrameContentSize(frame.data(), frame.size());
    if (size < least || size > most) {
        throw ProtocolError("a group of a batch does not hold what its tiles need");
    }
    if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
        throw ProtocolError("a group of a batch is not exactly one zstd frame");
    }
}

void FrameCodec::compress(std::span<std::uint8_t const> content, Bytes& frame) {
    if (!compressor_) {
        compressor_.reset(made(ZSTD_createCCtx()));
        ZSTD_CCtx_setParameter(compressor_.get(), ZSTD_c_compressionLevel, compression_level);
        ZSTD_CCtx_setParameter(compressor_.get(), ZSTD_c_minMatch, least_match);
    }
    frame.resize(ZSTD_compressBound(content.size()));
    std::size_t const written =
        ZSTD_compress2(compressor_.get(), frame.data(), frame.size(), content.data(), content.size());
    if (ZSTD_getErrorCode(written) == ZSTD_error_memory_allocation) {
        throw std::bad_alloc();
    }
    FRAMELET_CHECK(!ZSTD_isError(written));
    frame.resize(written);
}

std::span<std::uint8_t const> FrameCodec::decompress(ByteView frame) {
    if (!decompressor_) {
        decompressor_.reset(made(ZSTD_createDCtx()));
    }
    auto const size = static_cast<std::size_t>(ZSTD_getFrameContentSize(frame.data(), frame.size()));
    content_.resize(size);
    if (ZSTD_decompressDCtx(decompressor_.get(), content_.data(), size, frame.data(), frame.size()) != size) {
        throw ProtocolError("a group of a batch cannot be decompressed");
    }
    return content_;
}

} // namespace framelet
