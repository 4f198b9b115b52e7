// One octave of the Haar transform ([Haar 1910]) of a plane of samples in Morton order, where the four children of a
// block are neighbours, and its quantisation. In: four values of each block. Out: their mean, details and levels of
// these, and back.
#pragma once

#include <cstddef>
#include <cstdint>

namespace framelet {

/// Quantisation step: how details become levels.
struct DetailStep {
    /// `step` is 1 .. 32767.
    explicit DetailStep(std::uint16_t step);

    std::uint16_t step;
    std::uint16_t reciprocal; ///< floor(size reciprocal / 2^16) is the level
    std::uint16_t rounding; ///< added to a size first: rounds up what is no more than this short of the next level
};

/// Bits that a nonzero level takes in the entropy stage, roughly: `bits_of_any`, and its magnitude, which counts as at
/// most `most_bits_of_size`.
inline constexpr std::uint16_t bits_of_any = 5, most_bits_of_size = 8;

/// Transforms one octave, modulo 2^16. `children` has four values for each block: a b / c d. Their mean (a+b+c+d)/4 and
/// the details (a-b+c-d)/4, (a+b-c-d)/4, (a-b-c+d)/4, each rounded, become four `details`; `means` gets the means
/// alone, and `levels` the same as `quantise` gives. `details` may be `children`. `blocks` is at most 1000. Returns the
/// bits that the levels take, roughly.
int haar_forward(std::int16_t const* children, std::size_t blocks, DetailStep const& step, std::int16_t* means,
                 std::int16_t* details, std::int16_t* levels);

/// Quantises details to levels, with 0 where the means are. Returns the bits that they take, roughly.
int quantise(std::int16_t const* details, std::size_t blocks, DetailStep const& step, std::int16_t* levels);

/// Transforms back: details h, v, d, which are levels times `step`, and the means m give m+h+v+d, m-h+v-d, m+h-v-d,
/// m-h-v+d. The first of each four levels is not read. `out` may be `levels`.
void haar_inverse(std::int16_t const* means, std::int16_t const* levels, std::uint16_t step, std::size_t blocks,
                  std::int16_t* out);

} // namespace framelet
