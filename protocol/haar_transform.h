// One octave of the Haar transform of a plane of samples in Morton order, where the four children of a place are
// neighbours. In: fours of values. Out: their mean and three details, and back.
#pragma once

#include <cstddef>
#include <cstdint>

namespace framelet {

/// Arithmetic is modulo 2^16. `fours` has four values for each place: children a b / c d in; out the mean
/// (a+b+c+d)/4 and the details (a-b+c-d)/4, (a+b-c-d)/4, (a-b-c+d)/4, each rounded. `means` gets the means alone.
void haar_forward(std::int16_t* fours, std::int16_t* means, std::size_t places);

/// The other way: details h, v, d and the means m give m+h+v+d, m-h+v-d, m+h-v-d, m-h-v+d. The first of each four is
/// not read. `out` may be `fours`.
void haar_inverse(std::int16_t const* means, std::int16_t const* fours, std::size_t places, std::int16_t* out);

} // namespace framelet
