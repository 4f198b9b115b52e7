// Codes samples of a group of framelets as bytes and back: each framelet exact or with a QP of its own. PROTOCOL.md has
// the layout.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/exact_coding.h"
#include "protocol/codec/color/level_coding.h"
#include "protocol/codec/color/prediction.h"

namespace framelet {

/// Model of framelets: how likely each decision is, as those that were coded before have taught; the same on both
/// sides.
class PlaneModel {
public:
    /// Codes QP and prediction of the next framelet: writes them or reads them, as everything here. ProtocolError where
    /// the kind of prediction that is read is none.
    template <class Coder>
    void code_head(Coder& coder, bool may_be_predicted, std::uint8_t& qp, PredictionKind& kind, MotionVector& vector);

    LevelModel levels;
    ExactModel exact;

private:
    AdaptiveBit same_qp_;
    AdaptiveTree<7> qps_;
    std::uint8_t qp_ = 0; ///< that of the last framelet
    std::array<AdaptiveTree<2>, 2> kinds_; ///< of exact framelets; of others
    AdaptiveBit same_vector_;
    std::array<AdaptiveNumber<12>, 2> vectors_; ///< x, y, as differences from the last one
    MotionVector vector_; ///< the last one
};

/// Codes groups of framelets, with scratch that is reused.
class PlaneCodec {
public:
    /// Encodes a group of framelets; the bytes are valid until the next call. `qp`: one for each framelet, 0 (exact) ..
    /// coarsest_qp. `reference`: the picture from which they are predicted, and `decoded` as many framelets that get
    /// the samples which the viewer will see; null: each is coded alone.
    std::span<std::uint8_t const> encode(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> qp,
                                         PlaneModel& model, ReferencePicture const* reference = nullptr,
                                         std::span<DisplayFramelet> decoded = {});

    /// Fills samples and QPs of so many framelets, whose tiles are set and within the picture `reference`, which is
    /// null where they are coded alone. Throws ProtocolError where a value is out of its range or bytes are left over.
    static void decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                       std::span<std::uint8_t> qp, PlaneModel& model, ReferencePicture const* reference = nullptr);

private:
    RangeWriter writer_;
    MotionSearch search_;
    Prediction prediction_; ///< of the framelet at hand
};

} // namespace framelet
