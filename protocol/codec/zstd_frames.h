// What the sections of a batch have in common: groups of framelets, a frame of bytes each, and the lengths of the
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

/// Framelets that are compressed together, and apart from the others: enough for the compressor to learn from, few
/// enough to stay in the cache and to give every core some.
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

/// Lengths of all frames but the last, and the frames, one behind the other.
Bytes join_frames(std::span<Bytes const> frames);

/// The frames, where the lengths in front of them say they are; the last one is what is left. Nothing is decompressed
/// yet. ProtocolError where the payload is too short for them, or where there is something and no group.
std::vector<ByteView> split_frames(ByteView payload, std::size_t groups);

/// ProtocolError for all but one zstd frame that says how many bytes it holds, and these from `least` to `most`.
void check_frame(ByteView frame, std::size_t least, std::size_t most);

/// Scratch of the compressor and the decompressor, which is reused.
class FrameCodec {
public:
    /// One frame, in memory that is reused.
    void compress(std::span<std::uint8_t const> content, Bytes& frame);

    /// What a checked frame holds; valid until the next call. ProtocolError where it is damaged.
    std::span<std::uint8_t const> decompress(ByteView frame);

private:
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor_{nullptr, ZSTD_freeCCtx};
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> decompressor_{nullptr, ZSTD_freeDCtx};
    std::vector<std::uint8_t> content_;
};

} // namespace framelet
