// H.264 by x264 through libavcodec, set up as a low-latency streamer would: every picture comes out at once, no picture
// refers to a later one, no frame takes more than its share of the link.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "common/image.h"

namespace framelet::bench {

class H264Encoder {
public:
    /// Preset veryfast, tune zerolatency, one key frame at the start (TCP loses nothing), full-range BT.709, 4:2:0.
    /// `bits_per_second` > 0: at most that, with a buffer of one frame; 0: constant quality (crf 18). One thread: the
    /// same pictures give the same bytes. Throws InputError where libavcodec has no x264.
    H264Encoder(int width, int height, double frames_per_second, double bits_per_second);
    ~H264Encoder();

    /// The complete access unit of exactly this picture, which must have the encoder's size.
    std::vector<std::byte> encode(Picture const& picture);

private:
    struct State;
    std::unique_ptr<State> state_;
};

class H264Decoder {
public:
    H264Decoder();
    ~H264Decoder();

    /// One access unit, as the encoder gave it; `out` takes the picture's size. Throws InputError for damaged bytes.
    void decode(std::span<std::byte const> unit, Picture& out);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace framelet::bench
