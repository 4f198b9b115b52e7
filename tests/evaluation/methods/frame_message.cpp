#include "tests/evaluation/methods/frame_message.h"

#include <algorithm>
#include <cstring>

#include "common/error.h"

namespace framelet::bench {

std::vector<std::byte> frame_message(FrameHeader const& header, std::span<std::byte const> access_unit) {
    std::vector<std::byte> message(sizeof(header) + access_unit.size());
    std::memcpy(message.data(), &header, sizeof(header));
    std::ranges::copy(access_unit, message.begin() + std::ptrdiff_t{sizeof(header)});
    return message;
}

std::span<std::byte const> access_unit(std::span<std::byte const> message, FrameHeader& header) {
    FRAMELET_CHECK(message.size() >= sizeof(header));
    std::memcpy(&header, message.data(), sizeof(header));
    return message.subspan(sizeof(header));
}

} // namespace framelet::bench
