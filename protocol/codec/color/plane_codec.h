// Samples of a group of framelets to bytes before compression, and back: each framelet exact or with a quality of its
// own. PROTOCOL.md has the layout.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/exact_planes.h"
#include "protocol/codec/color/prediction.h"

namespace framelet {

/// Most bytes of a group of so many framelets.
constexpr std::size_t most_plane_bytes(std::size_t framelets) {
    std::size_t const haar = share_bytes + mean_bytes + most_detail_bytes;
    return 20 + framelets * (1 + std::max(haar, exact_framelet_bytes));
}
/// The same with predictions: of which kind each is, and a vector.
constexpr std::size_t most_predicted_bytes(std::size_t framelets) {
    return most_plane_bytes(framelets) + 3 * framelets;
}

/// The parts of a group's bytes, in order; their statistics differ.
using PlaneParts = std::array<std::span<std::uint8_t const>, 1 + token_parts>;

/// Scratch that is reused.
class PlaneCodec {
public:
    /// `quality`: one for each framelet, 0 (exact) .. coarsest_quality. `held`: what the viewer holds, from which those
    /// with loss are predicted, and `decoded` as many framelets that get the samples which the viewer will see; null:
    /// each is coded alone. The parts are valid until the next call.
    PlaneParts encode(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality,
                      HeldPicture const* held = nullptr, std::span<DisplayFramelet> decoded = {});

    /// Fills samples and qualities of so many framelets, whose tiles are set and within the picture `held`. That is
    /// null where they are coded alone. Throws ProtocolError.
    void decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                std::span<std::uint8_t> quality, HeldPicture const* held = nullptr);

private:
    void add_prediction(DisplayValues const& left, DisplayFramelet& framelet) const;
    void put_prediction();
    PlaneParts join(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality,
                    HaarWriter const& haar);

    std::vector<std::uint8_t> head_;
    std::vector<std::uint8_t> kinds_, vectors_; ///< of predictions; vectors: of those that moved, x and y
    HaarWriter::Memory haar_;
    VectorSearch search_;
    Prediction prediction_; ///< of the framelet at hand
};

} // namespace framelet
