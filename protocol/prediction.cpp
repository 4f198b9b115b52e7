#include "protocol/prediction.h"

#include <algorithm>

namespace framelet {
namespace {

/// What saying so takes, bits.
constexpr int bits_of_kind = 2, bits_of_vector = 12, bits_of_damping = 1;
/// Below this, looking further gains nothing.
constexpr int few_bits = 40;

DisplayValues values_at(HeldPicture const& held, Tile tile, PictureVector vector) {
    DisplayFramelet samples;
    held.predict(tile, vector, samples);
    return display_values(samples);
}

/// A way of coding a framelet.
struct Way {
    Prediction prediction;
    HaarValues left;
    HaarLevels levels; ///< of what is left
    std::array<int, HaarNumbers::octaves> octave_bits; ///< expected
    int bits; ///< of everything
};

Way code(HaarValues const& left, std::uint8_t quality) {
    Way way{{}, left, quantise(left, quality), {}, 0};
    way.bits = expected_bits_of_means(way.levels);
    for (std::size_t octave = 0; octave < HaarNumbers::octaves; ++octave) {
        way.octave_bits[octave] = expected_bits(way.levels, octave);
        way.bits += way.octave_bits[octave];
    }
    return way;
}

/// Puts one octave of `from` in the place of that of `to`.
void copy_octave(HaarNumbers const& from, std::size_t octave, HaarNumbers& to) {
    std::size_t const first = HaarNumbers::first_four[octave];
    for (std::size_t plane = 0; plane < 3; ++plane) {
        auto const begin = from.details[plane].begin() + static_cast<std::ptrdiff_t>(first);
        std::copy(begin, begin + static_cast<std::ptrdiff_t>(4 * HaarNumbers::places(octave)),
                  &to.details[plane][first]);
    }
}

/// Weakens those details of the prediction that are better not predicted, or not fully.
void choose_damping(HaarValues const& framelet, HaarValues const& predicted, Way const& alone, std::uint8_t quality,
                    Way& way) {
    for (std::size_t octave = 0; octave < Damping::octaves; ++octave) {
        int const whole = way.octave_bits[octave];
        if (whole <= bits_of_damping) {
            continue;
        }
        HaarValues halved = predicted;
        damp(halved, octave, Details::halved);
        Way half{{}, framelet - halved, {}, {}, 0};
        quantise_octave(half.left, quality, octave, half.levels);
        half.octave_bits[octave] = expected_bits(half.levels, octave);
        bool const is_none = alone.octave_bits[octave] <= half.octave_bits[octave];
        Way const& other = is_none ? alone : half;
        int const least = other.octave_bits[octave];
        if (least + bits_of_damping < whole) {
            way.prediction.damping.of[octave] = is_none ? Details::none : Details::halved;
            copy_octave(other.left, octave, way.left);
            copy_octave(other.levels, octave, way.levels);
            way.bits += least + bits_of_damping - whole;
            way.octave_bits[octave] = least;
        }
    }
}

} // namespace

std::uint8_t prediction_code(Prediction const& prediction) {
    if (prediction.kind == PredictionKind::none) {
        return 0;
    }
    int const finest = static_cast<int>(prediction.damping.of[0]), second = static_cast<int>(prediction.damping.of[1]);
    int const moved = prediction.kind == PredictionKind::moved ? 1 : 0;
    return static_cast<std::uint8_t>(1 + (moved * detail_choices + second) * detail_choices + finest);
}

Prediction prediction_of(std::uint8_t code) {
    if (code == 0) {
        return {};
    }
    int const rest = code - 1;
    Prediction prediction;
    prediction.damping.of[0] = static_cast<Details>(rest % detail_choices);
    prediction.damping.of[1] = static_cast<Details>(rest / detail_choices % detail_choices);
    prediction.kind = rest < detail_choices * detail_choices ? PredictionKind::same_place : PredictionKind::moved;
    return prediction;
}

DisplayValues predicted_values(HeldPicture const& held, Tile tile, Prediction const& prediction) {
    DisplayValues values = values_at(held, tile, prediction.vector);
    damp(values, prediction.damping);
    return values;
}

HaarLevels predict(HeldPicture const& held, DisplayFramelet const& framelet, std::uint8_t quality, VectorSearch& search,
                   Prediction& prediction) {
    HaarValues const whole = analyse(display_values(framelet));
    Way const alone = code(whole, quality);
    Way best = alone;
    auto const try_vector = [&](PredictionKind kind, PictureVector vector) {
        HaarValues const predicted = analyse(values_at(held, framelet.tile, vector));
        Way way = code(whole - predicted, quality);
        way.prediction = {kind, vector, {}};
        way.bits += bits_of_kind + (kind == PredictionKind::moved ? bits_of_vector : 0);
        choose_damping(whole, predicted, alone, quality, way);
        if (way.bits < best.bits) {
            best = way;
        }
    };
    try_vector(PredictionKind::same_place, {});
    if (best.bits > few_bits) {
        if (PictureVector const vector = search.find(held, framelet); vector != PictureVector{}) {
            try_vector(PredictionKind::moved, vector);
        }
    }
    share_luma(best.left, quality, best.levels);
    prediction = best.prediction;
    return best.levels;
}

} // namespace framelet
