#include "protocol/codec/color/plane_codec.h"

#include <cstdlib>
#include <limits>

#include "common/error.h"

namespace framelet {

template <class Coder>
void PlaneModel::code_head(Coder& coder, bool may_be_predicted, std::uint8_t& quality, PredictionKind& kind,
                           PictureVector& vector) {
    if (coder.bit(same_quality_, quality == quality_)) {
        quality = quality_;
    } else {
        quality = static_cast<std::uint8_t>(qualities_.code(coder, quality));
    }
    quality_ = quality;
    if (!may_be_predicted) {
        kind = PredictionKind::none;
        return;
    }
    unsigned const number = kinds_[quality == exact_quality ? 0 : 1].code(coder, static_cast<unsigned>(kind));
    if (number > static_cast<unsigned>(PredictionKind::moved)) {
        throw ProtocolError("a batch has a framelet of an unknown prediction");
    }
    kind = static_cast<PredictionKind>(number);
    vector = kind == PredictionKind::moved ? vector : PictureVector{};
    if (kind == PredictionKind::moved) {
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

template void PlaneModel::code_head(RangeWriter&, bool, std::uint8_t&, PredictionKind&, PictureVector&);
template void PlaneModel::code_head(RangeReader&, bool, std::uint8_t&, PredictionKind&, PictureVector&);

namespace {

/// Most are predicted from their own places.
void expect_next(HeldPicture const& held, std::span<DisplayFramelet const> framelets, std::size_t i) {
    if (i + 1 < framelets.size()) {
        held.expect(framelets[i + 1].tile);
    }
}

void add_prediction(DisplayValues const& left, Prediction const& prediction, DisplayFramelet& framelet) {
    if (prediction.kind == PredictionKind::none) {
        to_samples(left, framelet);
    } else {
        add_to_samples(left, prediction.samples, framelet);
    }
}

/// What is held in its own place is what an exact framelet is likely to be, if that was sent with loss before: where
/// it is, green tells.
bool resembles(DisplayFramelet const& framelet, DisplayFramelet const& held) {
    constexpr int alike = 12; // of a sample, on the average
    int sum = 0;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        sum += std::abs(framelet.green[i] - held.green[i]);
    }
    return sum < alike * framelet_samples;
}

DisplayFramelet const* samples_of(Prediction const& prediction) {
    return prediction.kind == PredictionKind::none ? nullptr : &prediction.samples;
}

} // namespace

std::span<std::uint8_t const> PlaneCodec::encode(std::span<DisplayFramelet const> framelets,
                                                 std::span<std::uint8_t const> quality, PlaneModel& model,
                                                 HeldPicture const* held, std::span<DisplayFramelet> decoded) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    FRAMELET_CHECK(held == nullptr || decoded.size() == quality.size());
    writer_.begin();
    search_.begin();
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        FRAMELET_CHECK(quality[i] <= coarsest_quality);
        DisplayFramelet const& framelet = framelets[i];
        bool const is_exact = quality[i] == exact_quality;
        prediction_.kind = PredictionKind::none;
        prediction_.vector = {};
        HaarLevels levels;
        if (held != nullptr && is_exact) {
            held->predict(framelet.tile, {}, prediction_.samples);
            prediction_.kind =
                resembles(framelet, prediction_.samples) ? PredictionKind::same_place : PredictionKind::none;
        } else if (held != nullptr) {
            expect_next(*held, framelets, i);
            levels = predict(*held, framelet, quality[i], search_, prediction_);
        } else if (!is_exact) {
            HaarCode alone;
            code(display_values(framelet), quality[i], std::numeric_limits<int>::max(), alone);
            share_luma(quality[i], alone);
            levels = alone.levels;
        }
        std::uint8_t own_quality = quality[i];
        model.code_head(writer_, held != nullptr, own_quality, prediction_.kind, prediction_.vector);
        if (is_exact) {
            DisplayFramelet copy = framelet;
            model.exact.code(writer_, samples_of(prediction_), copy);
            if (held != nullptr) {
                decoded[i] = framelet;
            }
        } else {
            model.levels.code(writer_, prediction_.kind != PredictionKind::none, levels);
            if (held != nullptr) {
                add_prediction(dequantise(levels, quality[i]), prediction_, decoded[i]);
            }
        }
    }
    return writer_.finish();
}

void PlaneCodec::decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                        std::span<std::uint8_t> quality, PlaneModel& model, HeldPicture const* held) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    RangeReader reader(bytes);
    Prediction prediction;
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        model.code_head(reader, held != nullptr, quality[i], prediction.kind, prediction.vector);
        if (prediction.kind != PredictionKind::none) {
            expect_next(*held, framelets, i);
            held->predict(framelets[i].tile, prediction.vector, prediction.samples);
        }
        if (quality[i] == exact_quality) {
            model.exact.code(reader, samples_of(prediction), framelets[i]);
        } else {
            HaarLevels levels{};
            model.levels.code(reader, prediction.kind != PredictionKind::none, levels);
            add_prediction(dequantise(levels, quality[i]), prediction, framelets[i]);
        }
    }
    if (!reader.is_at_end()) {
        throw ProtocolError("a group of a batch is longer than its framelets");
    }
}

} // namespace framelet
