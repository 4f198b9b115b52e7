// Codes positions as colours of samples: the colour that the viewer shows then tells where it took the sample from,
// whatever it did on the way. In: a column (or row) of the picture. Out: a byte; and the position again from a mean of
// squares of such bytes, which is what the viewer interpolates.
#pragma once

#include <cstdint>

namespace framelet::bench {

/// Steps from the lowest code to the highest. Codes go up and down with a period of twice this: neighbours differ by
/// one step everywhere. Two codes are shifted by a quarter of a period: where one turns round the other does not.
inline constexpr int position_steps = 31;

/// Code of the pixel in column (or row) `index`; `shift` is 0 or 1 and selects one of the two codes.
std::uint8_t position_byte(int index, int shift);

/// The position that a weighted mean of squares of such bytes stands for, in pixels (centres at halves): of the many
/// the one nearest to `near`. Exact for what is interpolated linearly between two neighbours, as long as no code turns
/// round between `near` and there.
float position_of(float mean_square, int shift, float near);

/// The code, 0 or 1, that turns round farther away from `near`.
int steady_shift(float near);

} // namespace framelet::bench
