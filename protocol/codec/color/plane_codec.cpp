#include "protocol/codec/color/plane_codec.h"

#include <cstdlib>
#include <limits>

#include "common/error.h"

namespace framelet {

template <class Coder>
void PlaneModel::code_head(Coder& coder, bool may_be_predicted, std::uint8_t& qp, PredictionKind& kind,
                           MotionVector& vector) {
    if (coder.bit(same_qp_, qp == qp_)) {
        qp = qp_;
    } else {
        qp = static_cast<std::uint8_t>(qps_.code(coder, qp));
    }
    qp_ = qp;
    if (!may_be_predicted) {
        kind = PredictionKind::intra;
        return;
    }
    unsigned const number = kinds_[qp == lossless_qp ? 0 : 1].code(coder, static_cast<unsigned>(kind));
    if (number > static_cast<unsigned>(PredictionKind::displaced)) {
        throw ProtocolError("a batch has a framelet of an unknown prediction");
    }
    kind = static_cast<PredictionKind>(number);
    vector = kind == PredictionKind::displaced ? vector : MotionVector{};
    if (kind == PredictionKind::displaced) {
        if (coder.bit(same_vector_, vector == vector_)) {
            vector = vector_;
        } else {
            auto const moved = [&](std::size_t axis, std::int8_t value, std::int8_t from) {
                return static_cast<std::int8_t>(from +
                                                vectors_[axis].code(coder, static_cast<std::int16_t>(value - from)));
            };
            vector = {moved(0, vector.x, vector_.x), moved(1, vector.y, vector_.y)};
        }
        vector_ = vector;
    }
}

template void PlaneModel::code_head(RangeWriter&, bool, std::uint8_t&, PredictionKind&, MotionVector&);
template void PlaneModel::code_head(RangeReader&, bool, std::uint8_t&, PredictionKind&, MotionVector&);

namespace {

/// Prepares the prediction of the next framelet from its own tile, since most are predicted from there.
void expect_next(ReferencePicture const& reference, std::span<DisplayFramelet const> framelets, std::size_t i) {
    if (i + 1 < framelets.size()) {
        reference.expect(framelets[i + 1].tile);
    }
}

void add_prediction(DisplayValues const& left, Prediction const& prediction, DisplayFramelet& framelet) {
    if (prediction.kind == PredictionKind::intra) {
        to_samples(left, framelet);
    } else {
        add_to_samples(left, prediction.samples, framelet);
    }
}

/// True where an exact framelet is close to what the reference picture has in its tile, as it is where the same was
/// sent with loss before. Green alone is compared.
bool resembles(DisplayFramelet const& framelet, DisplayFramelet const& reference) {
    constexpr int alike = 12; // levels a sample, on the average
    int sum = 0;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        sum += std::abs(framelet.green[i] - reference.green[i]);
    }
    return sum < alike * framelet_samples;
}

DisplayFramelet const* samples_of(Prediction const& prediction) {
    return prediction.kind == PredictionKind::intra ? nullptr : &prediction.samples;
}

} // namespace

std::span<std::uint8_t const> PlaneCodec::encode(std::span<DisplayFramelet const> framelets,
                                                 std::span<std::uint8_t const> qp, PlaneModel& model,
                                                 ReferencePicture const* reference,
                                                 std::span<DisplayFramelet> decoded) {
    FRAMELET_CHECK(framelets.size() == qp.size());
    FRAMELET_CHECK(reference == nullptr || decoded.size() == qp.size());
    writer_.begin();
    search_.begin();
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        FRAMELET_CHECK(qp[i] <= coarsest_qp);
        DisplayFramelet const& framelet = framelets[i];
        bool const is_exact = qp[i] == lossless_qp;
        prediction_.kind = PredictionKind::intra;
        prediction_.vector = {};
        HaarLevels levels;
        if (reference != nullptr && is_exact) {
            reference->predict(framelet.tile, {}, prediction_.samples);
            prediction_.kind =
                resembles(framelet, prediction_.samples) ? PredictionKind::colocated : PredictionKind::intra;
        } else if (reference != nullptr) {
            expect_next(*reference, framelets, i);
            levels = predict(*reference, framelet, qp[i], search_, prediction_);
        } else if (!is_exact) {
            HaarCode alone;
            code(display_values(framelet), qp[i], std::numeric_limits<int>::max(), alone);
            share_luma(qp[i], alone);
            levels = alone.levels;
        }
        std::uint8_t own_qp = qp[i];
        model.code_head(writer_, reference != nullptr, own_qp, prediction_.kind, prediction_.vector);
        if (is_exact) {
            DisplayFramelet copy = framelet;
            model.exact.code(writer_, samples_of(prediction_), copy);
            if (reference != nullptr) {
                decoded[i] = framelet;
            }
        } else {
            model.levels.code(writer_, prediction_.kind != PredictionKind::intra, levels);
            if (reference != nullptr) {
                add_prediction(dequantise(levels, qp[i]), prediction_, decoded[i]);
            }
        }
    }
    return writer_.finish();
}

void PlaneCodec::decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                        std::span<std::uint8_t> qp, PlaneModel& model, ReferencePicture const* reference) {
    FRAMELET_CHECK(framelets.size() == qp.size());
    RangeReader reader(bytes);
    Prediction prediction;
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        model.code_head(reader, reference != nullptr, qp[i], prediction.kind, prediction.vector);
        if (prediction.kind != PredictionKind::intra) {
            expect_next(*reference, framelets, i);
            reference->predict(framelets[i].tile, prediction.vector, prediction.samples);
        }
        if (qp[i] == lossless_qp) {
            model.exact.code(reader, samples_of(prediction), framelets[i]);
        } else {
            HaarLevels levels{};
            model.levels.code(reader, prediction.kind != PredictionKind::intra, levels);
            add_prediction(dequantise(levels, qp[i]), prediction, framelets[i]);
        }
    }
    if (!reader.is_at_end()) {
        throw ProtocolError("a group of a batch is longer than its framelets");
    }
}

} // namespace framelet
