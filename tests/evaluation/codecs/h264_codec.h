// H.264 ([ITU-T H.264]) by x264 through libavcodec, set up as a low-latency streamer would: every picture comes out at
// once, no picture refers to a later one, no frame takes more than it may.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "common/image.h"

namespace framelet::bench {

class H264Encoder {
public:
    /// Preset veryfast, tuned for the mean squared error and zero latency, 4:4:4, full-range BT.709, one key frame at
    /// the start (TCP loses nothing; x264 makes another where the scene is cut). One thread: the same pictures give the
    /// same bytes. Throws InputError where libavcodec has no x264.
    H264Encoder(int width, int height, double frames_per_second);
    ~H264Encoder();

    /// Returns the complete access unit of exactly this picture, which must have the encoder's size. `most_bytes`:
    /// bytes that the frame may take, > 0, which may change from frame to frame as the link does; infinite: whatever
    /// constant quality (crf 8) takes, which is never exceeded. x264 keeps to it within some per cent, the first frame
    /// apart.
    std::vector<std::byte> encode(Picture const& picture, double most_bytes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

class H264Decoder {
public:
    H264Decoder();
    ~H264Decoder();

    /// Decodes one access unit, as the encoder gave it; `out` takes the picture's size. Throws InputError for damaged
    /// bytes.
    void decode(std::span<std::byte const> unit, Picture& out);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace framelet::bench
