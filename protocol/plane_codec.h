// Samples of a group of framelets to bytes before compression, and back: each framelet exact or with a quality of its
// own. PROTOCOL.md has the layout.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet.h"
#include "protocol/exact_planes.h"
#include "protocol/haar_planes.h"

namespace framelet {

/// Most bytes of a group of so many framelets.
constexpr std::size_t most_plane_bytes(std::size_t framelets) {
    std::size_t const haar =
        mean_bytes + most_token_bytes(coarse_details + fine_details) + most_escape_bytes(coarse_details + fine_details);
    return 12 + framelets * (1 + std::max(haar, exact_framelet_bytes));
}

/// The parts of a group's bytes, in order; their statistics differ.
using PlaneParts = std::array<std::span<std::uint8_t const>, 3>;

/// Scratch that is reused.
class PlaneCodec {
public:
    /// `quality`: one for each framelet, 0 (exact) .. coarsest_quality. The parts are valid until the next call.
    PlaneParts encode(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality);

    /// Fills samples and qualities of so many framelets. Throws ProtocolError.
    void decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                std::span<std::uint8_t> quality);

private:
    std::vector<std::uint8_t> head_;
    HaarWriter::Memory haar_;
};

} // namespace framelet
