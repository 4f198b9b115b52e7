// Codes whole frames of changing sample spacing with H.264: a stream of its own for each spacing, each of which refers
// to its own last picture. In: pictures of one pixel a sample. Out: messages, and back.
#pragma once

#include <map>

#include "tests/evaluation/codecs/h264_codec.h"
#include "tests/evaluation/method.h"

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

struct FrameHeader {
    SceneTime time = 0;
    double spacing = 1; ///< pixels
};

/// A message of the frame's scene time, its sample spacing and the access unit.
std::vector<std::byte> frame_message(FrameHeader const& header, std::span<std::byte const> access_unit);

/// Decodes such messages and shows them at full size.
class H264FrameViewer {
public:
    explicit H264FrameViewer(MethodSetup const& setup);

    ViewerStep consume(std::span<std::byte const> message);
    Picture const& picture() const { return picture_; }
    SceneTime time() const { return header_.time; }

private:
    CostTable const costs_;
    ScaledH264Decoder decoder_;
    FrameHeader header_;
    Picture decoded_, picture_;
};

} // namespace framelet::bench
