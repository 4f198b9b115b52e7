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

/// Codes what is left.
void code(std::uint8_t quality, Way& way) {
    way.levels = quantise(way.left, quality);
    way.bits = expected_bits_of_means(way.levels);
    for (std::size_t octave = 0; octave < HaarNumbers::octaves; ++octave) {
        way.octave_bits[octave] = expected_bits(way.levels, octave);
        way.bits += way.octave_bits[octave];
    }
}

/// Calls `use` with where an octave of a plane begins in each of `numbers`, for every plane.
template <typename Use, typename... Numbers>
void for_each_plane_of(std::size_t octave, Use const& use, Numbers&... numbers) {
    for (std::size_t plane = 0; plane < 3; ++plane) {
        use(&numbers.details[plane][HaarNumbers::first_four[octave]]...);
    }
}

/// Puts one octave of `from` in the place of that of `to`.
void copy_octave(HaarNumbers const& from, std::size_t octave, HaarNumbers& to) {
    std::size_t const count = 4 * HaarNumbers::places(octave);
    for_each_plane_of(
        octave, [count](std::int16_t const* in, std::int16_t* out) { std::copy(in, in + count, out); }, from, to);
}

/// What is left of one octave beside half of its prediction.
void subtract_half(HaarValues const& framelet, HaarValues const& predicted, std::size_t octave, HaarValues& left) {
    std::size_t const count = 4 * HaarNumbers::places(octave);
    auto const subtract = [count](std::int16_t const* whole, std::int16_t const* other, std::int16_t* out) {
        std::transform(whole, whole + count, other, out,
                       [](std::int16_t a, std::int16_t b) { return static_cast<std::int16_t>(a - (b >> 1)); });
    };
    for_each_plane_of(octave, subtract, framelet, predicted, left);
}

/// Weakens those details of the prediction that are better not predicted, or not fully.
void choose_damping(HaarValues const& framelet, HaarValues const& predicted, Way const& alone, std::uint8_t quality,
                    Way& way) {
    for (std::size_t octave = 0; octave < Damping::octaves; ++octave) {
        int const whole = way.octave_bits[octave];
        if (whole <= bits_of_damping) {
            continue;
        }
        Way half;
        subtract_half(framelet, predicted, octave, half.left);
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
    Way alone, at_place, moved;
    alone.left = analyse(display_values(framelet));
    code(quality, alone);
    Way* best = &alone;
    auto const try_vector = [&](PredictionKind kind, PictureVector vector, Way& way) {
        HaarValues const predicted = analyse(values_at(held, framelet.tile, vector));
        way.left = alone.left - predicted;
        code(quality, way);
        way.prediction = {kind, vector, {}};
        way.bits += bits_of_kind + (kind == PredictionKind::moved ? bits_of_vector : 0);
        choose_damping(alone.left, predicted, alone, quality, way);
        if (way.bits < best->bits) {
            best = &way;
        }
    };
    try_vector(PredictionKind::same_place, {}, at_place);
    if (best->bits > few_bits) {
        if (PictureVector const vector = search.find(held, framelet); vector != PictureVector{}) {
            try_vector(PredictionKind::moved, vector, moved);
        }
    }
    share_luma(best->left, quality, best->levels);
    prediction = best->prediction;
    return best->levels;
}

} // namespace framelet
