// The message of a whole frame that a picture codec made: of when it is and how far apart its samples are, then the
// codec's bytes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/framelet.h"

namespace framelet::bench {

struct FrameHeader {
    SceneTime time = 0;
    double spacing = 1; ///< pixels
};

std::vector<std::byte> frame_message(FrameHeader const& header, std::span<std::byte const> access_unit);
/// Takes such a message apart: sets the header, returns the access unit.
std::span<std::byte const> access_unit(std::span<std::byte const> message, FrameHeader& header);

} // namespace framelet::bench
