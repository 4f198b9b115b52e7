// Groups of framelets, which the sections of a batch have in common: a frame of bytes for each, and the lengths of the
// frames in front of them; and frames of zstd. PROTOCOL.md has the layout.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>
#include <zstd.h>

#include "protocol/messages/message.h"

namespace framelet {

/// Framelets of a group, which are compressed together, and apart from the others: enough for the compressor to learn
/// from, few enough to stay in the cache and to give every core some.
inline constexpr std::size_t group_framelets = 128;

constexpr std::size_t group_count(std::size_t framelets) {
    return (framelets + group_framelets - 1) / group_framelets;
}

/// Calls `body(group, first framelet, count)` for every group, in parallel.
template <typename Body>
void for_each_group(std::size_t framelets, Body const& body) {
    tbb::parallel_for(std::size_t{0}, group_count(framelets), [&](std::size_t group) {
        std::size_t const first = group * group_framelets;
        body(group, first, std::min(group_framelets, framelets - first));
    });
}

/// Joins frames into a payload: the lengths of all but the last, then the frames, one behind the other.
Bytes join_frames(std::span<Bytes const> frames);

/// Splits a payload into its frames, by the lengths in front of them; the last one is what is left. Nothing is
/// decompressed yet. ProtocolError where the payload is too short for them, or where there is something and no group.
std::vector<ByteView> split_frames(ByteView payload, std::size_t groups);

/// Throws ProtocolError unless the bytes are one zstd frame that says how many bytes it holds, and these are `least` to
/// `most`.
void check_frame(ByteView frame, std::size_t least, std::size_t most);

/// Compresses and decompresses zstd frames, with scratch that is reused.
class FrameCodec {
public:
    /// Compresses the content into one frame, whose memory is reused.
    void compress(std::span<std::uint8_t const> content, Bytes& frame);

    /// Decompresses a checked frame; the content is valid until the next call. ProtocolError where the frame is
    /// damaged.
    std::span<std::uint8_t const> decompress(ByteView frame);

private:
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor_{nullptr, ZSTD_freeCCtx};
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> decompressor_{nullptr, ZSTD_freeDCtx};
    std::vector<std::uint8_t> content_;
};

} // namespace framelet
