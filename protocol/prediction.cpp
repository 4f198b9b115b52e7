#include "protocol/prediction.h"

#include <limits>

namespace framelet {
namespace {

/// What saying so takes, bits.
constexpr int bits_of_kind = 2, bits_of_vector = 12;
/// Below this, looking further gains nothing.
constexpr int few_bits = 70;

/// A way of coding a framelet.
struct Way {
    Prediction prediction;
    HaarCode code; ///< of what is left
    int bits = 0; ///< expected; at least so many
};

} // namespace

HaarLevels predict(HeldPicture const& held, DisplayFramelet const& framelet, std::uint8_t quality, VectorSearch& search,
                   Prediction& prediction) {
    auto const code_at = [&](PictureVector vector, int bits_beside, int most, Way& way) {
        way.prediction.vector = vector;
        held.predict(framelet.tile, vector, way.prediction.samples);
        way.bits =
            code(difference(framelet, way.prediction.samples), quality, most - bits_beside, way.code) + bits_beside;
    };
    constexpr int any = std::numeric_limits<int>::max();
    Way at_place, alone, moved;
    at_place.prediction.kind = PredictionKind::same_place;
    code_at({}, bits_of_kind, any, at_place);
    Way* best = &at_place;
    if (best->bits > few_bits) {
        alone.bits = code(display_values(framelet), quality, best->bits, alone.code);
        best = alone.bits <= best->bits ? &alone : best;
        PictureVector const vector = search.find(held, framelet);
        if (best->bits > few_bits && vector != PictureVector{}) {
            moved.prediction.kind = PredictionKind::moved;
            code_at(vector, bits_of_kind + bits_of_vector, best->bits, moved);
            best = moved.bits < best->bits ? &moved : best;
        }
        share_luma(quality, best->code);
    }
    prediction = best->prediction;
    return best->code.levels;
}

} // namespace framelet
