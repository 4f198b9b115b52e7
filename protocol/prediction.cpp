#include "protocol/prediction.h"

namespace framelet {
namespace {

/// What saying so takes, bits.
constexpr int bits_of_kind = 2, bits_of_vector = 12;
/// Below this, looking further gains nothing.
constexpr int few_bits = 70;

/// A way of coding a framelet.
struct Way {
    Prediction prediction;
    HaarValues left;
    HaarLevels levels; ///< of what is left
    int bits = 0; ///< expected
};

void code(DisplayValues const& left, std::uint8_t quality, int bits_beside, Way& way) {
    way.left = analyse(left);
    way.levels = quantise(way.left, quality);
    way.bits = expected_bits(way.levels) + bits_beside;
}

} // namespace

HaarLevels predict(HeldPicture const& held, DisplayFramelet const& framelet, std::uint8_t quality, VectorSearch& search,
                   Prediction& prediction) {
    DisplayValues const values = display_values(framelet);
    auto const code_at = [&](PictureVector vector, int bits_beside, Way& way) {
        way.prediction.vector = vector;
        held.predict(framelet.tile, vector, way.prediction.samples);
        code(values - display_values(way.prediction.samples), quality, bits_beside, way);
    };
    Way at_place, alone, moved;
    at_place.prediction.kind = PredictionKind::same_place;
    code_at({}, bits_of_kind, at_place);
    Way* best = &at_place;
    if (best->bits > few_bits) {
        code(values, quality, 0, alone);
        best = alone.bits <= best->bits ? &alone : best;
        PictureVector const vector = search.find(held, framelet);
        if (best->bits > few_bits && vector != PictureVector{}) {
            moved.prediction.kind = PredictionKind::moved;
            code_at(vector, bits_of_kind + bits_of_vector, moved);
            best = moved.bits < best->bits ? &moved : best;
        }
        share_luma(best->left, quality, best->levels);
    }
    prediction = best->prediction;
    return best->levels;
}

} // namespace framelet
