#include "protocol/codec/color/prediction.h"

#include <limits>

namespace framelet {
namespace {

/// Bits that the kind of a prediction and its vector take, roughly.
constexpr int bits_of_kind = 2, bits_of_vector = 12;
/// A number of bits so small that, where a way of coding takes no more, looking for a better one gains nothing.
constexpr int few_bits = 70;

/// A way of coding a framelet.
struct Way {
    Prediction prediction;
    HaarCode code; ///< of the residual
};

} // namespace

HaarLevels predict(ReferencePicture const& reference, DisplayFramelet const& framelet, std::uint8_t qp,
                   MotionSearch& search, Prediction& prediction) {
    Way colocated, alone, moved;
    colocated.prediction.kind = PredictionKind::colocated;
    moved.prediction.kind = PredictionKind::displaced;
    Way* best = &alone;
    int least = std::numeric_limits<int>::max();
    // The way that is likely the best one comes first: all others end where they take more.
    auto const consider = [&](Way& way, DisplayValues const& values, int bits_beside) {
        int const bits = code(values, qp, least - bits_beside, way.code) + bits_beside;
        if (bits < least) {
            best = &way;
            least = bits;
        }
    };
    auto const consider_from = [&](MotionVector vector, Way& way, int bits_beside) {
        way.prediction.vector = vector;
        reference.predict(framelet.tile, vector, way.prediction.samples);
        consider(way, difference(framelet, way.prediction.samples), bits_beside);
    };
    bool const may_have_moved = search.has_moved();
    if (!may_have_moved) {
        consider_from({}, colocated, bits_of_kind);
    }
    if (least > few_bits) {
        MotionVector const vector = search.find(reference, framelet);
        if (vector != MotionVector{}) {
            consider_from(vector, moved, bits_of_kind + bits_of_vector);
        }
        if (may_have_moved) {
            consider_from({}, colocated, bits_of_kind);
        }
        if (least > few_bits) {
            consider(alone, display_values(framelet), 0);
        }
        share_luma(qp, best->code);
    }
    search.note_moved(best == &moved);
    prediction = best->prediction;
    return best->code.levels;
}

} // namespace framelet
