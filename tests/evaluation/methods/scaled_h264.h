// H.264 of frames whose samples are now further apart and now closer: a stream of its own for each size, each of which
// refers to its own last picture. In: pictures of one pixel a sample. Out: access units, and back.
#pragma once

#include <map>

#include "tests/evaluation/codecs/h264_codec.h"

namespace framelet::bench {

class ScaledH264Encoder {
public:
    explicit ScaledH264Encoder(double frames_per_second) : frames_per_second_(frames_per_second) {}

    std::vector<std::byte> encode(int spacing, Picture const& picture, double most_bytes) {
        auto& stream = streams_.try_emplace(spacing, picture.width, picture.height, frames_per_second_).first->second;
        return stream.encode(picture, most_bytes);
    }

private:
    double const frames_per_second_;
    std::map<int, H264Encoder> streams_;
};

class ScaledH264Decoder {
public:
    void decode(int spacing, std::span<std::byte const> unit, Picture& out) { streams_[spacing].decode(unit, out); }

private:
    std::map<int, H264Decoder> streams_;
};

} // namespace framelet::bench
