#include "protocol/prediction.h"

#include <utility>

namespace framelet {
namespace {

/// What saying so takes, bits.
constexpr int bits_of_kind = 2, bits_of_vector = 12;
/// Below this, looking further gains nothing.
constexpr int few_bits = 40;

} // namespace

HaarLevels predict(HeldPicture const& held, DisplayFramelet const& framelet, std::uint8_t quality, VectorSearch& search,
                   Prediction& prediction) {
    DisplayValues const values = display_values(framelet);
    auto const left_at = [&](PictureVector vector, Prediction& tried) {
        tried.vector = vector;
        held.predict(framelet.tile, vector, tried.samples);
        return quantise(values - display_values(tried.samples), quality);
    };
    HaarLevels best = left_at({}, prediction);
    prediction.kind = PredictionKind::same_place;
    int least = expected_bits(best) + bits_of_kind;
    if (least <= few_bits) {
        return best;
    }
    if (HaarLevels const alone = quantise(values, quality); expected_bits(alone) <= least) {
        least = expected_bits(alone);
        best = alone;
        prediction.kind = PredictionKind::none;
    }
    if (PictureVector const vector = search.find(held, framelet); least > few_bits && vector != PictureVector{}) {
        Prediction tried{PredictionKind::moved, {}, {}};
        HaarLevels const left = left_at(vector, tried);
        if (expected_bits(left) + bits_of_kind + bits_of_vector < least) {
            best = left;
            prediction = tried;
        }
    }
    return best;
}

} // namespace framelet
