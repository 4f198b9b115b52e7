#include "tests/evaluation/methods/h264_frames.h"

#include <algorithm>
#include <cstring>

#include "common/error.h"
#include "tests/evaluation/methods/frame_grid.h"
#include "tests/evaluation/methods/margin.h"

namespace framelet::bench {

std::vector<std::byte> frame_message(FrameHeader const& header, std::span<std::byte const> access_unit) {
    std::vector<std::byte> message(sizeof(header) + access_unit.size());
    std::memcpy(message.data(), &header, sizeof(header));
    std::ranges::copy(access_unit, message.begin() + std::ptrdiff_t{sizeof(header)});
    return message;
}

H264FrameViewer::H264FrameViewer(MethodSetup const& setup)
    : costs_(setup.costs), picture_(setup.viewport.width, setup.viewport.height) {}

ViewerStep H264FrameViewer::consume(std::span<std::byte const> message) {
    FRAMELET_CHECK(message.size() >= sizeof(header_));
    std::memcpy(&header_, message.data(), sizeof(header_));
    auto const spacing = static_cast<int>(header_.spacing);
    decoder_.decode(spacing, message.subspan(sizeof(header_)), decoded_);
    upsample(decoded_, spacing, picture_);
    ViewerStep step;
    step.seconds.decode = 1e-9 * pixel_count(decoded_) * costs_.h264_decode_pixel;
    step.seconds.reconstruct = spacing > 1 ? 1e-9 * pixel_count(picture_) * costs_.reconstruct_pixel : 0;
    return step;
}

} // namespace framelet::bench
