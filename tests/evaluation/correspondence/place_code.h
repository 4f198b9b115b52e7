// Places written into the colours of samples: what the viewer then shows tells where it took it from, whatever it did
// on the way. In: a column (or row) of the picture. Out: a byte, and back from the mean of squares of such bytes, which
// is what the viewer interpolates.
#pragma once

#include <cstdint>

namespace framelet::bench {

/// Codes go up and down with a period of twice this: neighbours differ by one step everywhere. Two codes half a
/// period's half apart: where one turns round the other does not.
inline constexpr int place_steps = 31;

/// Of the pixel in column (or row) `index`; `shift` is 0 or 1 and tells the two codes apart.
std::uint8_t place_byte(int index, int shift);

/// The place that such bytes' weighted mean of squares stands for, in pixels (centres at halves): of the many the one
/// nearest to `near`. Exact for what is interpolated linearly between two neighbours, as long as no code turns round
/// between `near` and there.
float place_of(float mean_square, int shift, float near);

/// The code that turns round farther away from `near`.
int steady_shift(float near);

} // namespace framelet::bench
