// Samples of a group of framelets to bytes and back: each framelet exact or with a quality of its own. PROTOCOL.md has
// the layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/exact_coding.h"
#include "protocol/codec/color/level_coding.h"
#include "protocol/codec/color/prediction.h"

namespace framelet {

/// What is known of the framelets that were coded before. Both sides know the same.
class PlaneModel {
public:
    /// Quality and prediction of the next framelet: codes both ways, as everything here.
    template <class Coder>
    void code_head(Coder& coder, bool may_be_predicted, std::uint8_t& quality, PredictionKind& kind,
                   PictureVector& vector);

    LevelModel levels;
    ExactModel exact;

private:
    AdaptiveBit same_quality_;
    AdaptiveTree<7> qualities_;
    std::uint8_t quality_ = 0; ///< of the last one
    std::array<AdaptiveTree<2>, 2> kinds_; ///< of exact ones; of others
    AdaptiveBit same_vector_;
    std::array<AdaptiveNumber<12>, 2> vectors_; ///< x, y: as differences
    PictureVector vector_; ///< the last one
};

/// Scratch that is reused.
class PlaneCodec {
public:
    /// `quality`: one for each framelet, 0 (exact) .. coarsest_quality. `held`: what the viewer holds, from which they
    /// are predicted, and `decoded` as many framelets that get the samples which the viewer will see; null: each is
    /// coded alone. The bytes are valid until the next call.
    std::span<std::uint8_t const> encode(std::span<DisplayFramelet const> framelets,
                                         std::span<std::uint8_t const> quality, PlaneModel& model,
                                         HeldPicture const* held = nullptr, std::span<DisplayFramelet> decoded = {});

    /// Fills samples and qualities of so many framelets, whose tiles are set and within the picture `held`. That is
    /// null where they are coded alone. Throws ProtocolError.
    static void decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                       std::span<std::uint8_t> quality, PlaneModel& model, HeldPicture const* held = nullptr);

private:
    RangeWriter writer_;
    VectorSearch search_;
    Prediction prediction_; ///< of the framelet at hand
};

} // namespace framelet
